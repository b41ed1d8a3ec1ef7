/// Reads a recording without the types of this program: the IDL text in the file describes the samples.
///   example_read_recording run.mcap crane/state
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "crane/recording/mcap_reader.hpp"
#include "crane/recording/schema.hpp"

namespace {

/// Prints the first three samples of `topic` and the number of all samples.
void print_topic(crane::recording::McapReader& recording, const std::string& topic) {
  int count = 0;
  recording.for_each({.topics = {topic}}, [&](const crane::recording::Message& message) {
    if (++count > 3) return true;
    const auto* record = recording.find_schema(message.channel->schema_id);
    const crane::recording::Schema schema{record->text};
    std::printf("%s\n", schema.decode(record->name, message.data).dump().c_str());
    return true;
  });
  std::printf("%d samples of %s\n", count, topic.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s FILE.mcap TOPIC\n", argv[0]);
    return 2;
  }
  try {
    crane::recording::McapReader recording{argv[1]};
    print_topic(recording, argv[2]);
    for (const auto& problem : recording.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
