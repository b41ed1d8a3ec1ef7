// The page: views, theme, connection, the stop that every view shows.
import { Desk, drawSoftwareStop } from "./desk.js";
import { forgetColours } from "./drawing.js";
import { FaultsView } from "./faults.js";
import { Link } from "./link.js";
import { NetworkView } from "./network.js";
import { OperateView } from "./operate.js";
import { PlotsView } from "./plots.js";
import { DiagnoseView, RunsModel, RunsView } from "./runs.js";
import { Signals } from "./signals.js";

const find = (id) => document.getElementById(id);
const VIEWS = ["operate", "plots", "network", "faults", "runs", "diagnose"];

function theme(name) {
  document.documentElement.dataset.theme = name;
  localStorage.setItem("crane-theme", name);
  find("theme").textContent = name === "dark" ? "Light" : "Dark";
  forgetColours();
  document.dispatchEvent(new Event("themechange"));
}
theme(localStorage.getItem("crane-theme") ?? (matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark"));
find("theme").onclick = () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");

const link = new Link(location.origin.replace(/^http/, "ws") + "/");
const desk = new Desk();
const signals = new Signals(link);
const operate = new OperateView(link, desk);
const plots = new PlotsView(link, signals);
const network = new NetworkView(link);
const faults = new FaultsView(link, (fault) => {
  location.hash = "plots";
  plots.showMoment(fault);
});

const recorded = new RunsModel(desk);
const runs = new RunsView(recorded), diagnose = new DiagnoseView(recorded);

function show() {
  const wanted = location.hash.slice(1);
  const shown = VIEWS.includes(wanted) ? wanted : "operate";
  for (const view of VIEWS) find("view-" + view).hidden = view !== shown;
  for (const tab of document.querySelectorAll(".tabs a"))
    tab.getAttribute("href") === "#" + shown ? tab.setAttribute("aria-current", "page") : tab.removeAttribute("aria-current");
  for (const view of [operate, plots, network, faults, runs, diagnose]) view.shown?.(shown);
  window.dispatchEvent(new Event("resize"));
}
window.addEventListener("hashchange", show);
show();

link.listen("dashboard/situation", (situation) => desk.update({ situation }));
link.listen("crane/supervisor", (sample) => { desk.seen = `${sample.get("header.epoch")}-${sample.get("header.tick")}`; });
link.listen("dashboard/operator", ({ operator }) => desk.update({ holder: operator }));
link.addEventListener("change", () => {
  find("link-state").dataset.state = link.state;
  find("link-state").textContent = { live: "live", lost: "connection lost" }[link.state] ?? "connecting";
  find("lost").hidden = link.state !== "lost";
  desk.update({ lost: link.state === "lost" });
  if (link.state === "live") desk.load().then(() => { find("crane-name").textContent = desk.about.crane ?? "crane"; document.title = (desk.about.crane ?? "crane") + " – dashboard"; });
});
desk.addEventListener("change", () => drawSoftwareStop(desk, find("estop")));
find("estop").onclick = () => desk.ask({ kind: "estop" });
desk.load();

// For measurements and tests: pictures drawn, bytes received.
window.craneDashboard = { link, get frames() { return operate.scene.frames; } };
