// Draws the plots of a page with uPlot, each when it comes into view. Data: libs/report/src/plot_data.hpp.
(() => {
  "use strict";
  const palette = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf",
                   "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22", "#003f88", "#7a0019"];
  const groups = new Map();  // name -> {plots, zoom, shown}

  const decode = ({e, d}) => {
    const power = 10 ** Math.abs(e);
    let sum = 0;
    return d.map((step) => step === null ? null : (sum += step, e < 0 ? sum / power : sum * power));
  };

  // uPlot needs one x for all series: the rows have the x of all columns, and undefined where a column has no value.
  const aligned = (xs, columns) => {
    if (xs.length === 1) return [xs[0], ...columns.map((column) => column.y)];
    const entries = xs.flatMap((x, column) => x.map((value, i) => ({value, column, i})));
    entries.sort((a, b) => a.value - b.value || a.column - b.column || a.i - b.i);
    const rows = [];
    for (const {value, column, i} of entries) {
      let row = rows[rows.length - 1];
      if (!row || row.value !== value || row.at[column] !== undefined) rows.push(row = {value, at: []});
      row.at[column] = i;
    }
    return [rows.map((row) => row.value),
            ...columns.map(({x, y}) => rows.map((row) => row.at[x] === undefined ? undefined : y[row.at[x]]))];
  };

  const shortened = (u, value) => value == null ? "" : String(Number(value.toPrecision(5)));

  // The default labels of uPlot have three decimals, so that labels of a nearly constant curve would be equal.
  const ticks = (u, splits, axis, space, step) => {
    const decimals = Math.min(12, Math.max(0, Math.ceil(-Math.log10(step)) + 1));
    return splits.map((value) => value == null ? "" : String(Number(value.toFixed(decimals))));
  };

  const look = (series, shown) => {
    const color = palette[series.color % palette.length];
    const common = {label: series.name, stroke: color, width: 1.5, value: shortened,
                    show: shown.get(series.name) ?? !series.hidden};
    if (series.style === "points") return {...common, paths: () => null, points: {show: true, size: 5, fill: color}};
    if (series.style === "band") return {...common, width: 0.5, points: {show: false}};
    return {...common, dash: series.dashed ? [8, 5] : undefined, points: {show: false}};
  };

  const draw = (element) => {
    const plot = JSON.parse(element.querySelector("script").textContent);
    const group = groups.get(plot.group) ?? {plots: [], zoom: null, shown: new Map()};
    if (plot.group) groups.set(plot.group, group);

    const columns = [], looks = [{label: plot.xLabel || "x", value: shortened}], bands = [];
    const edges = new Map();  // a band is two series: its lower edge has the legend, its upper edge follows
    for (const series of plot.series) {
      columns.push({x: series.x, y: decode(series.y)});
      looks.push(look(series, group.shown));
      if (series.style !== "band") continue;
      columns.push({x: series.x, y: decode(series.upper)});
      looks.push({...look(series, group.shown), class: "upper-edge"});
      edges.set(columns.length - 1, columns.length);
      bands.push({series: [columns.length, columns.length - 1],
                  fill: palette[series.color % palette.length] + "33"});
    }

    let ready = false, following = false;
    const follow = (change) => { following = true; change(); following = false; };
    const others = (change) => {
      for (const other of group.plots) if (other.u !== u) other.follow(() => change(other.u));
    };
    const whole = (chart) => ({min: chart.data[0][0], max: chart.data[0].at(-1)});
    const hooks = {
      setScale: [(chart, key) => {
        if (key !== "x" || !ready || following) return;
        const {min, max} = chart.scales.x, all = whole(chart);
        group.zoom = min <= all.min && max >= all.max ? null : {min, max};
        others((other) => other.setScale("x", group.zoom ?? whole(other)));
      }],
      setSeries: [(chart, index, change) => {
        if (index === null || change.show === undefined) return;
        if (edges.has(index)) chart.setSeries(edges.get(index), {show: change.show});
        if (following) return;
        const name = chart.series[index].label;
        group.shown.set(name, change.show);
        others((other) => other.series.forEach((series, i) => {
          if (i > 0 && series.label === name && series.show !== change.show) other.setSeries(i, {show: change.show});
        }));
      }],
    };
    const options = {
      width: element.clientWidth, height: 300, series: looks, bands, hooks,
      scales: {x: {time: false}},
      axes: [{label: plot.xLabel, labelSize: 22, size: 34, values: ticks},
             {label: plot.yLabel, labelSize: 22, size: 80, values: ticks}],
      cursor: plot.group ? {sync: {key: plot.group, setSeries: false,
                                   filters: {pub: (type) => type === "mousemove" || type === "mouseleave"}}} : {},
      legend: {live: true},
    };
    const u = new uPlot(options, aligned(plot.xs.map(decode), columns), element);
    group.plots.push({u, follow});
    if (group.zoom) follow(() => u.setScale("x", group.zoom));
    // uPlot sets its scales in a microtask. Later changes come from the reader.
    queueMicrotask(() => { ready = true; });
    new ResizeObserver(() => u.setSize({width: element.clientWidth, height: 300})).observe(element);
  };

  const watcher = new IntersectionObserver((entries) => {
    for (const {isIntersecting, target} of entries) {
      if (!isIntersecting) continue;
      watcher.unobserve(target);
      draw(target);
    }
  }, {rootMargin: "200px"});
  for (const element of document.querySelectorAll(".plot")) watcher.observe(element);
})();
