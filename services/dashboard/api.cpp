#include "dashboard/api.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>

#include "crane/runtime/process.hpp"
#include "crane/runtime/request_kinds.hpp"
#include "dashboard/hold.hpp"
#include "dashboard/packed_samples.hpp"
#include "dashboard/page_files.hpp"
#include "dashboard/request_text.hpp"
#include "stack/stack.hpp"
#include "stack/wiring_graph.hpp"

namespace crane::dashboard {
namespace {

using nlohmann::ordered_json;

/// Parses "topic=crane/state&from=1" to pairs. If a key occurs more than once, the last value counts.
std::map<std::string, std::string, std::less<>> parameters_of(std::string_view query) {
  std::map<std::string, std::string, std::less<>> parameters;
  while (!query.empty()) {
    const auto end = std::min(query.find('&'), query.size());
    const auto pair = query.substr(0, end);
    const auto equals = std::min(pair.find('='), pair.size());
    parameters[std::string{pair.substr(0, equals)}] = pair.substr(std::min(equals + 1, pair.size()));
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return parameters;
}

template <class Number>
Number number_of(const std::string& text, const char* name) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size())
    throw BadRequest(std::string{name} + ": must be a whole number");
  return number;
}

constexpr const char* kJsonType = "application/json";

/// True when the content type is `wanted`, with or without parameters ("application/json; charset=utf-8").
bool has_type(const ApiRequest& request, std::string_view wanted) {
  const std::string_view type = request.content_type;
  return type.substr(0, type.find_first_of("; \t")) == wanted;
}

/// @throws BadRequest when the body is no request
bool stops(const ApiRequest& request) {
  return request.target == "/api/request" && runtime::is_urgent_stop(operator_request_of(request.body).kind);
}

std::size_t topic_index(const std::string& name) {
  const auto found = std::ranges::find(topics::kAll, name, &topics::Description::name);
  if (found == topics::kAll.end())
    throw BadRequest("topic: no topic has the name '" + name.substr(0, 64) + "'");
  return static_cast<std::size_t>(found - topics::kAll.begin());
}

}  // namespace

ApiAnswer json_answer(const ordered_json& json, unsigned status) {
  return {.status = status, .body = text_of(json)};
}

ApiAnswer problem_answer(unsigned status, const std::string& what) {
  return json_answer({{"error", what}}, status);
}

Api::Api(Model& model, const AccessRules& rules,
         std::function<void(const stack::OperatorRequest&, Answered)> send,
         std::function<ServerCounts()> counts, const RunsOptions& runs)
    : model_{model}, rules_{rules}, send_{std::move(send)}, counts_{std::move(counts)}, runs_{runs} {}

void Api::handle(const ApiRequest& request, AnswerHandler answer) {
  try {
    if (!may_look(rules_, request.visitor))
      answer(problem_answer(403, "this dashboard answers its own pages only: open it by its address"));
    else if (request.method == "POST")
      post(request, answer);  // a copy of `answer`: an exception of post() is answered below
    else if (request.method == "GET" || request.method == "HEAD")
      answer(get(request));
    else
      answer(problem_answer(405, "GET, HEAD or POST is expected"));
  } catch (const BadRequest& error) {
    answer(problem_answer(400, error.what()));
  }
}

bool Api::is_permitted_stop(const ApiRequest& request) const {
  try {
    return request.method == "POST" && has_type(request, kJsonType) && stops(request) &&
           why_not_stop(rules_, request.visitor).empty();
  } catch (const BadRequest&) {
    return false;
  }
}

ApiAnswer Api::get(const ApiRequest& request) {
  const std::string_view target{request.target};
  const auto path = target.substr(0, target.find('?'));
  const auto query = path.size() < target.size() ? target.substr(path.size() + 1) : std::string_view{};
  if (const auto* file = find_page_file(path))
    return {.status = 200, .media_type = std::string{file->media_type}, .body = "", .file = file->bytes};
  if (path == "/metrics")
    return {.status = 200,
            .media_type = "text/plain; version=0.0.4",
            .body = metrics(model_, counts_(), runtime::monotonic_ns())};
  if (path == "/api/about") return about(request.visitor);
  if (path == "/api/situation") return {.body = model_.text(Document::situation)};
  if (path == "/api/seen") return newest_status();
  if (path == "/api/traffic") return {.body = model_.text(Document::traffic)};
  if (path == "/api/faults") return {.body = model_.text(Document::faults)};
  if (path == "/api/operator") return {.body = model_.text(Document::seat)};
  if (path == "/api/graph") return json_answer(stack::wiring_json(stack::all_components()));
  if (path == "/api/idl") return {.media_type = "text/plain", .body = std::string{topics::idl_text()}};
  if (path == "/api/history") return history(query);
  if (auto answer = runs_.get(path)) return *std::move(answer);
  if (path == "/api/request" || path.starts_with("/api/operator/"))
    return problem_answer(405, "POST is expected");
  return problem_answer(404, "this path does not exist; docs/dashboard.md lists the paths");
}

ApiAnswer Api::newest_status() const {
  const auto& status = model_.situation().supervisor();
  return json_answer({{"seen", status ? ordered_json(status_id(status->header)) : ordered_json(nullptr)}});
}

ApiAnswer Api::about(const Visitor& visitor) const {
  const auto& about = model_.about();
  const auto why_not = why_not_operate(rules_, visitor);
  return json_answer({{"version", about.version},
                      {"crane", about.crane},
                      {"domain", about.domain},
                      {"rig", about.rig.empty() ? ordered_json(nullptr) : ordered_json::parse(about.rig)},
                      {"may_operate", why_not.empty()},
                      {"why_not", why_not},
                      {"may_stop", why_not_stop(rules_, visitor).empty()},
                      {"token_helps", !rules_.token.empty() && !rules_.read_only}});
}

ApiAnswer Api::history(std::string_view query) const {
  auto parameters = parameters_of(query);
  const auto topic = topic_index(parameters["topic"]);
  ApiAnswer answer{.media_type = "application/octet-stream", .body = ""};
  if (parameters.contains("fault")) {
    const auto* fault = model_.faults().find(number_of<std::uint64_t>(parameters["fault"], "fault"));
    if (fault == nullptr || !fault->surrounding_samples.contains(topic))
      return problem_answer(404, "the dashboard has no data of this fault");
    answer.body = packed(fault->surrounding_samples.at(topic));
    return answer;
  }
  constexpr std::int64_t kEver_ns = std::numeric_limits<std::int64_t>::max();
  const auto from_ns = parameters.contains("from") ? number_of<std::int64_t>(parameters["from"], "from") : 0;
  const auto to_ns = parameters.contains("to") ? number_of<std::int64_t>(parameters["to"], "to") : kEver_ns;
  answer.body = packed(model_.history().between(topic, from_ns, to_ns));
  return answer;
}

void Api::post(const ApiRequest& request, AnswerHandler answer) {
  // A form of a foreign page can send text/plain, but cannot send these types without a preflight request.
  const std::string wanted = request.target.starts_with(kUploadPath) ? "application/octet-stream" : kJsonType;
  if (!has_type(request, wanted))
    return answer(problem_answer(415, "content type " + wanted + " is expected"));
  const auto why_not =
      stops(request) ? why_not_stop(rules_, request.visitor) : why_not_operate(rules_, request.visitor);
  if (!why_not.empty()) return answer(problem_answer(403, why_not));
  const auto now_ns = runtime::monotonic_ns();
  if (request.target == "/api/operator/take") return answer(take_seat(request));
  if (request.target == "/api/operator/renew")
    return answer(model_.seat().renew(request.seat_key, now_ns)
                      ? json_answer({{"held", true}})
                      : problem_answer(409, "another operator has the controls, or the time has run out"));
  if (request.target == "/api/operator/release") {
    const bool held = model_.seat().release(request.seat_key, now_ns);
    return answer(json_answer({{"held", false}, {"released", held}}));
  }
  if (auto done = runs_.post(request)) return answer(*std::move(done));
  if (request.target == "/api/request") return this->request(request, std::move(answer));
  answer(problem_answer(404, "this path accepts no POST; docs/dashboard.md lists the paths"));
}

ApiAnswer Api::take_seat(const ApiRequest& request) {
  const auto body = nlohmann::json::parse(request.body, nullptr, false);
  const bool named = body.is_object() && body.contains("name") && body["name"].is_string();
  auto key = random_token();
  if (!model_.seat().take(named ? body["name"].get<std::string>() : "operator", key, runtime::monotonic_ns()))
    return problem_answer(
        409,
        *model_.seat().holder(runtime::monotonic_ns()) +
            " has the controls; they become free when that page releases them, or 10 s after it was closed");
  return json_answer({{"seat", key}});
}

void Api::request(const ApiRequest& request, AnswerHandler answer) {
  auto wanted = operator_request_of(request.body);
  const auto reply_with = [answer](const Reply& reply) {
    answer(json_answer({{"accepted", reply.accepted}, {"reason", reply.reason}}));
  };
  if (!runtime::is_urgent_stop(wanted.kind)) {
    const auto now_ns = runtime::monotonic_ns();
    if (!model_.seat().renew(request.seat_key, now_ns))
      return answer(problem_answer(409, "take the controls first: one operator at a time"));
    // An interrupted connection can deliver a request late. The supervisor compares this tick with the last
    // stop. Without a supervisor, the answer of RequestSender names the remedy.
    const auto named = model_.situation().status_of(request.status_id, now_ns);
    if (!named && !runtime::stops_crane(wanted.kind) && model_.situation().hears_supervisor(now_ns))
      return reply_with(
          {false, request.status_id.empty()
                      ? "the header X-Crane-Seen is missing: state the newest status that has arrived (GET "
                        "/api/seen)"
                      : "the request names no status of the last 2 s (X-Crane-Seen): repeat the request"});
    if (is_hold(wanted) && model_.situation().hears_supervisor(now_ns)) {
      const auto* state = model_.situation().state_within(kHoldAge_ns, now_ns);
      if (state == nullptr)
        return reply_with({false, "no crane/state has arrived within 0.25 s: request a stop instead"});
      wanted = move_to_rest(*state, *model_.situation().supervisor(), model_.about().reference_acceleration);
    }
    wanted.newest_status = named.value_or(msg::Header{});
  }
  send_(wanted, reply_with);
}

}  // namespace crane::dashboard
