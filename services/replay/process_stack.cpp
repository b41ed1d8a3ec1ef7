#include "replay/process_stack.hpp"

#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "crane/files/complete_file.hpp"
#include "crane/runtime/process.hpp"

namespace crane::replay {
namespace {

constexpr std::int64_t kPatience_ns = 10'000'000'000;

std::string rig_file(const std::filesystem::path& directory, const std::string& text) {
  const auto file = directory / "rig.toml";
  files::write_file(file, text);
  return file.string();
}

}  // namespace

ProcessReplay::ProcessReplay(std::vector<runtime::ComponentSpec> components, const RecordedRun& run,
                             const ProcessOptions& options)
    : components_{std::move(components)},
      directory_{"crane_replay"},
      launch_{.bus = options.bus,
              .vendors = options.vendors,
              .rig = rig_file(directory_.path(), run.rig_text()),
              .controller = std::string{run.controller().name},
              .clock = "lockstep",
              .epoch = 1,
              .priority = 0},
      bus_{[this] {
        launch_.bus.crane += "_replay_" + std::to_string(::getpid());  // differs from that of a running crane
        auto own = runtime::bus_options(launch_.bus, "crane_replay", crane_SOURCE_MONITOR, 1);
        own.fast_heartbeats = true;  // deliver() waits for every sample of the stick
        return bus::Bus{own};
      }()},
      replies_{bus_.subscriber(topics::reply)},
      outputs_{bus_, components_, run.rig().design},
      writers_{[this](const std::string&, crane_Source source, std::uint32_t epoch) {
        return bus_.share(source, epoch);
      }} {}

ProcessReplay::~ProcessReplay() { children_.stop(); }

template <class Condition>
void ProcessReplay::until(Condition condition, const std::string& what) {
  const auto deadline_ns = runtime::monotonic_ns() + kPatience_ns;
  while (!condition()) {
    if (const auto ended = children_.ended()) throw std::runtime_error(stack::describe(*ended));
    if (runtime::stop_requested()) throw std::runtime_error("interrupted");
    if (runtime::monotonic_ns() > deadline_ns)
      throw std::runtime_error("waited " + std::to_string(kPatience_ns / 1'000'000'000) + " s for " + what);
    bus_.wait(std::chrono::milliseconds{20});
  }
}

void ProcessReplay::start(const Cdr& first_state) {
  writers_.open_clock_master(first_state);
  stack::launch(children_, components_, launch_);
  stack::wait_until_ready(children_, components_, bus_, std::chrono::seconds{60});
  until([this] { return replies_.matched() > 0; }, "the replies of the supervisor");
  started_ = true;
}

bool ProcessReplay::receive(const RecordedTick& tick) {
  const auto* state = tick.find(topics::state.description);
  if (state == nullptr) return false;
  if (!started_) start(*state);
  for (const auto& input : tick.inputs)
    if (!deliver(input, tick.number)) return false;
  if (!writers_.publish_state(*state)) return false;
  until(
      [&] {
        outputs_.take();
        return outputs_.missing(tick.number).empty();
      },
      "tick " + std::to_string(tick.number) + " of the processes");
  return true;
}

bool ProcessReplay::deliver(const Received& input, std::uint64_t tick) {
  if (input.topic->name == topics::request.description.name) {
    auto request = decoded(topics::request, input.cdr);
    if (!request) return false;
    request->apply_tick = std::max(request->apply_tick, tick);
    schedule(writers_.operator_of(request->header, request->client), *request);
    return true;
  }
  const auto jog = decoded(topics::jog, input.cdr);
  if (!jog) return false;
  auto& sender = writers_.operator_of(jog->header, jog->client);
  until([&] { return sender.jogs.matched() > 0; }, "the supervisor to discover a writer of crane/jog");
  if (!sender.jogs.publish(*jog)) return false;
  until([&] { return sender.jogs.wait_until_acknowledged(std::chrono::milliseconds{20}); },
        "the supervisor to receive a sample of crane/jog");
  return true;
}

/// Publishes the request again only when no confirmation arrives within 0.5 s: the supervisor then has not
/// discovered the writer. The supervisor would execute every copy that it receives.
void ProcessReplay::schedule(RecordedWriters::Operator& sender, const msg::Request& request) {
  until([&] { return sender.requests.matched() > 0; }, "the supervisor to receive requests");
  std::int64_t repeat_ns = 0;
  until(
      [&] {
        if (const auto now_ns = runtime::monotonic_ns(); now_ns >= repeat_ns) {
          constexpr std::int64_t kRepeat_ns = 500'000'000;
          if (!sender.requests.publish(request)) throw std::runtime_error("a request could not be sent");
          repeat_ns = now_ns + kRepeat_ns;
        }
        return is_scheduled(request);
      },
      "the confirmation of a request");
}

bool ProcessReplay::is_scheduled(const msg::Request& request) {
  while (const auto reply = replies_.take())
    if (reply->request_id == request.id && std::string_view{reply->client} == request.client &&
        (std::string_view{reply->reason} == "scheduled" || !reply->accepted))
      return true;
  return false;
}

}  // namespace crane::replay
