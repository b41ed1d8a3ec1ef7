// The HTTP paths of the views Runs and Diagnose, and attacks on them.
#include <sys/stat.h>

#include "../recording/temporary_directory.hpp"
#include "server_fixture.hpp"

namespace crane::dashboard {
namespace {

using recording::put_contents;

constexpr const char* kOperatorToken = "0123456789abcdef0123456789abcdef";

/// Created before the server that uses this directory.
struct Files {
  Files() {
    std::filesystem::create_directories(directory / "runs");
    put_contents(directory / "runs/stop.mcap", "1");
    put_contents(directory / "secret.mcap", "1");
    put_contents(directory / "crane",
                 "#!/bin/bash\necho '{\"sentences\":[]}'; echo '<p>page</p>' > \"${@: -1}\"\n");
    ::chmod((directory / "crane").c_str(), 0700);
  }
  recording::TemporaryDirectory directory;
};

class RunsApiTest : protected Files, public ServerTest {
 protected:
  explicit RunsApiTest(AccessRules rules = {})
      : ServerTest{std::move(rules),
                   {.program = directory / "crane", .directory = directory / "runs", .rig = "rig.toml"}} {}
  Response upload(const std::string& name, const std::string& bytes, const std::string& token = "",
                  const std::string& type = "application/octet-stream", const std::string& origin = "") {
    http::request<http::string_body> request{http::verb::post, "/api/uploads/" + name, 11, bytes};
    request.set(http::field::content_type, type);
    if (!token.empty()) request.set(http::field::authorization, "Bearer " + token);
    if (!origin.empty()) request.set(http::field::origin, origin);
    return exchange(std::move(request));
  }
  /// Status of the answer to the header of an upload of `bytes` bytes, which is refused before its body is
  /// sent.
  std::string announced(std::uint64_t bytes) {
    const auto answer = raw(
        "POST /api/uploads/lab.csv HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/octet-stream\r\n"
        "Content-Length: " +
        std::to_string(bytes) + "\r\n\r\n");
    return answer.size() < 12 ? "" : answer.substr(9, 3);
  }
  /// The job after its end. The server polls its jobs in every frame period, in which each viewer gets a
  /// message.
  json ended(std::uint64_t id) {
    constexpr std::chrono::seconds kPatience{30};
    auto beats = view(kViewerProtocol);
    const auto end = std::chrono::steady_clock::now() + kPatience;
    do {
      const auto all = json::parse(get("/api/jobs").body());
      for (const auto& job : all["jobs"])
        if (job["id"] == id && job["state"] != "running" && job["state"] != "waiting") return job;
      (void)read(beats);
    } while (std::chrono::steady_clock::now() < end);
    ADD_FAILURE() << "job " << id << " has not ended within " << kPatience.count() << " s";
    return {};
  }
};

TEST_F(RunsApiTest, ListsReviewsAndServesThePageInAnOriginOfItsOwn) {
  const auto list = json::parse(get("/api/runs").body());
  ASSERT_EQ(list["runs"].size(), 1U);
  EXPECT_EQ(list["runs"][0]["name"], "stop.mcap");
  const auto started = post("/api/runs/review", {{"run", "stop.mcap"}});
  ASSERT_EQ(started.result_int(), 200U) << started.body();
  const auto id = json::parse(started.body())["job"].get<std::uint64_t>();
  EXPECT_EQ(ended(id)["state"], "done");
  EXPECT_EQ(json::parse(get("/api/jobs/" + std::to_string(id) + "/result").body())["sentences"],
            json::array());
  const auto page = get("/api/jobs/" + std::to_string(id) + "/report");
  EXPECT_EQ(page.body(), "<p>page</p>\n");
  const auto rules = page["Content-Security-Policy"];
  EXPECT_NE(rules.find("sandbox allow-scripts"), beast::string_view::npos);
  EXPECT_EQ(rules.find("allow-same-origin"), beast::string_view::npos);
}

TEST_F(RunsApiTest, OpensNoFileOutsideItsDirectory) {
  for (const std::string& name : {std::string{"../secret.mcap"}, (directory / "secret.mcap").string(),
                                  std::string{"..%2fsecret.mcap"}, std::string{"/etc/passwd"}}) {
    EXPECT_EQ(post("/api/runs/review", {{"run", name}}).result_int(), 400U) << name;
    EXPECT_EQ(post("/api/runs/diagnose", {{"train", {name}}, {"test", {"stop.mcap"}}}).result_int(), 400U)
        << name;
    EXPECT_EQ(upload(name, "1").result_int(), 400U) << name;
  }
  for (const auto* path : {"/api/jobs/1/report/../../../etc/passwd", "/api/jobs/99999999999999999999/report",
                           "/api/jobs/-1/result", "/api/jobs/1/errors.txt", "/api/jobs/"})
    EXPECT_EQ(get(path).result_int(), 404U) << path;
}

TEST_F(RunsApiTest, AnswersInvalidRequestsWithAReason) {
  for (const auto& body :
       {json{{"run", 1}}, json{{"run", nullptr}}, json{{"run", json::array({json::array()})}}, json::array(),
        json{}, json{{"run", std::vector<std::string>(9, "stop.mcap")}}})
    EXPECT_EQ(post("/api/runs/review", body).result_int(), 400U) << body;
  EXPECT_EQ(post("/api/runs/diagnose", {{"train", {"stop.mcap"}}}).result_int(), 400U);
  EXPECT_EQ(post("/api/jobs/cancel", {{"job", "1"}}).result_int(), 404U);
}

TEST_F(RunsApiTest, KeepsAnUploadAndListsIt) {
  const std::string bytes(100'000, 'x');
  EXPECT_EQ(upload("lab.csv", bytes).result_int(), 200U);
  const auto list = json::parse(get("/api/runs").body())["runs"];
  ASSERT_EQ(list.size(), 2U);
  EXPECT_TRUE(list[0]["name"] == "upload:lab.csv" || list[1]["name"] == "upload:lab.csv") << list;
}

TEST_F(RunsApiTest, RefusesLargeBodiesForeignPagesAndForms) {
  EXPECT_EQ(announced(kLongestUpload_bytes + 1), "413");
  EXPECT_EQ(post("/api/runs/review", {{"run", std::string(kLongestBody_bytes, 'x')}}).result_int(), 413U);
  EXPECT_EQ(upload("lab.csv", "1", "", "text/plain").result_int(), 415U);
  EXPECT_EQ(upload("lab.csv", "1", "", "application/octet-stream", "http://evil.example").result_int(), 403U);
  EXPECT_EQ(json::parse(get("/api/runs").body())["runs"].size(), 1U);
}

class RunsApiWithToken : public RunsApiTest {
 protected:
  RunsApiWithToken()
      : RunsApiTest{{.token = kOperatorToken, .host_names = {}, .other_origins = {}, .read_only = false}} {}
};

TEST_F(RunsApiWithToken, StartsAndKeepsNothingWithoutTheToken) {
  EXPECT_EQ(get("/api/runs").result_int(), 200U) << "looking needs none";
  EXPECT_EQ(post("/api/runs/review", {{"run", "stop.mcap"}}).result_int(), 403U);
  EXPECT_EQ(post("/api/runs/diagnose", {{"train", {"stop.mcap"}}, {"test", {"stop.mcap"}}}).result_int(),
            403U);
  EXPECT_EQ(upload("lab.csv", "1").result_int(), 403U);
  EXPECT_EQ(announced(100'000), "413") << "a stranger's body stays small";
  EXPECT_EQ(json::parse(get("/api/jobs").body())["jobs"].size(), 0U);
  EXPECT_EQ(upload("lab.csv", "1", kOperatorToken).result_int(), 200U);
}

using WithoutRuns = ServerTest;

TEST_F(WithoutRuns, NothingIsListedAndNothingStarted) {
  EXPECT_EQ(json::parse(get("/api/runs").body())["runs"].size(), 0U);
  EXPECT_EQ(post("/api/runs/review", {{"run", "stop.mcap"}}).result_int(), 404U);
}

}  // namespace
}  // namespace crane::dashboard
