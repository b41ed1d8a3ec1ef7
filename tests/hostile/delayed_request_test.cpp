/// The connection of an operator is interrupted while a request is on its way. The dashboard tells its
/// operator after 2 s that the supervisor has not answered. Afterwards the middleware delivers the request:
/// DDS repeats a sample for as long as the reader does not acknowledge it. Permitted: the request is refused.
/// Forbidden: the crane moves after its operator was told that it does not.
#include <gmock/gmock.h>

#include <cstdlib>

#include "../recording/temporary_directory.hpp"
#include "armed_crane.hpp"
#include "dashboard_attackers.hpp"

namespace crane::hostile {
namespace {

/// The datagrams that a program sends while `lost()` are lost (tests/system/lossy_sockets.cpp). Only programs
/// that start during the lifetime of this object can lose datagrams.
class Interruption {
 public:
  explicit Interruption(std::filesystem::path file) : file_{std::move(file)} {
    lose(0);
    ::setenv("CRANE_LOST_FILE", file_.c_str(), 1);
    ::setenv("LD_PRELOAD", (stack::program_directory() / "liblossy_sockets.so").c_str(), 1);
  }
  ~Interruption() {
    ::unsetenv("LD_PRELOAD");
    ::unsetenv("CRANE_LOST_FILE");
  }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  /// Writes in place: the program has mapped the file.
  void lose(double share) const {
    std::ofstream out{file_,
                      std::ios::binary | (std::filesystem::exists(file_) ? std::ios::in : std::ios::out)};
    out.write(reinterpret_cast<const char*>(&share), sizeof share);
  }

 private:
  std::filesystem::path file_;
};

/// The parameter is the DDS vendor of the dashboard.
class DelayedRequest : public ArmedCrane, public testing::WithParamInterface<const char*> {
 protected:
  DelayedRequest() {
    auto arguments = runtime::arguments(options(GetParam()));
    arguments.insert(arguments.end(), {"--port", std::to_string(port_), "--rig", "virginia_tech_tower"});
    stack_.children().start("dashboard", "crane_dashboard", arguments);
    EXPECT_TRUE(client_.answers(10s));
  }
  /// True when the supervisor has answered a request of the dashboard; it refuses a reset of an armed crane.
  bool is_connected() {
    return client_.post("/api/request", R"({"kind":"reset"})", "", seat_) == 200 &&
           client_.body().find("armed") != std::string::npos;
  }
  void take_controls() {
    ASSERT_EQ(client_.post("/api/operator/take", "{}", ""), 200U);
    const auto at = client_.body().find("\":\"") + 3;
    seat_ = client_.body().substr(at, client_.body().find('"', at) - at);
  }

  recording::TemporaryDirectory directory_;
  Interruption interruption_{directory_ / "lost_share"};
  unsigned short port_ = free_port();
  Client client_{port_};
  std::string seat_;
};

TEST_P(DelayedRequest, OfAnOperatorWhoWasToldThatNobodyAnswersMovesNothing) {
  bus::Bus bus{runtime::bus_options(options(), "listener", crane_SOURCE_MONITOR, 0)};
  auto replies = bus.subscriber(topics::reply);
  take_controls();
  ASSERT_TRUE(stack_.until([this] { return is_connected(); }, 8s));
  // On a busy computer, resets that nobody answered within 2 s precede the answered one; the middleware may
  // deliver them late, too. The dashboard numbers its requests upwards, and the move follows all resets.
  std::uint64_t answered_reset = 0;
  ASSERT_TRUE(stack_.until(
      [&] {
        while (const auto reply = replies.take())
          if (std::string{reply->reason}.find("armed") != std::string::npos)
            answered_reset = reply->request_id;
        return answered_reset != 0;
      },
      3s));
  const auto answer_to_the_move = [&]() -> std::string {
    while (const auto reply = replies.take())
      if (reply->request_id > answered_reset) return reply->reason;
    return "";
  };
  stack_.forget();
  interruption_.lose(1);
  ASSERT_EQ(client_.post("/api/request", R"({"kind":"move","trolley_m":0.9})", "", seat_), 200U);
  ASSERT_THAT(client_.body(), testing::HasSubstr("did not answer")) << "the connection was not interrupted";
  stack_.listen(300ms);
  ASSERT_EQ(answer_to_the_move(), "");
  interruption_.lose(0);
  std::string answer;
  EXPECT_TRUE(stack_.until([&] { return !(answer = answer_to_the_move()).empty(); }, 3s))
      << "the request did not arrive, or was accepted";
  EXPECT_THAT(answer, testing::HasSubstr("names no tick of the last 2 s"));
  stack_.listen(500ms);
  expect_hold();
  EXPECT_TRUE(is_connected()) << client_.body();
}

INSTANTIATE_TEST_SUITE_P(OfBothVendors, DelayedRequest, testing::Values("cyclone", "fastdds"));

}  // namespace
}  // namespace crane::hostile
