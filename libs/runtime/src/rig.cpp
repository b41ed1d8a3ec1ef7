#include "crane/runtime/rig.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "crane/runtime/toml_reader.hpp"
#include "rig_sections.hpp"

namespace crane::runtime {
namespace {

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    throw ConfigurationError({file.string() + ":1: file: cannot be read"});
  }
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Document with the values of the files it extends underneath its own.
TomlTable with_base(const std::string& text, const std::filesystem::path& file,
                    std::vector<std::filesystem::path> chain) {
  TomlTable document(text, file.string());
  const std::string extended = document.text("extends", "");
  if (extended.empty()) return document;
  chain.push_back(file.lexically_normal());
  const auto base = (file.parent_path() / extended).lexically_normal();
  if (std::find(chain.begin(), chain.end(), base) != chain.end()) {
    document.problem("extends", "must not lead back to this file");
  } else if (!std::filesystem::is_regular_file(base)) {
    document.problem("extends", "must name a rig file, relative to this one");
  } else {
    document.inherit(with_base(contents(base), base, chain));
  }
  return document;
}

RigKind read_kind(TomlTable& root) {
  const std::string kind = root.choice("kind", {"tower", "gantry", "drive_axis", "pendulum"});
  if (kind == "gantry") return RigKind::gantry;
  if (kind == "drive_axis") return RigKind::drive_axis;
  if (kind == "pendulum") return RigKind::pendulum;
  return RigKind::tower;
}

}  // namespace

Rig load_rig(const std::filesystem::path& file) { return parse_rig(contents(file), file.string()); }

Rig parse_rig(const std::string& text, const std::string& file) {
  TomlTable root = with_base(text, file, {});
  Rig rig;
  rig.path = file;
  rig.name = root.text("name");
  if (root.has("name") && rig.name.empty()) root.problem("name", "must not be empty");
  rig.kind = read_kind(root);
  rig.period_s = root.number("period_s", Range::above(0, 0.1), rig.period_s);
  rig.board = root.choice("board", {"simulated", "servo_to_go", "comedi", "emulated"}, rig.board);
  read_drives(root, rig);
  read_encoders(root, rig);
  read_plant(root, rig);
  read_terms(root, rig);
  read_sensing(root, rig);
  read_limits(root, rig);
  read_start(root, rig);
  read_controller(root, rig);
  root.finish();
  return rig;
}

}  // namespace crane::runtime
