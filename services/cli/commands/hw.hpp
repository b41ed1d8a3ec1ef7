#pragma once
/// What the commands of `crane hw` share: the rig, its board in this process's hands, and time.
#include <memory>
#include <string>

#include "crane/bridge/component.hpp"
#include "crane/bring_up/session.hpp"
#include "crane/runtime/node.hpp"

namespace CLI {
class App;
}

namespace crane::cli {

struct BoardOptions {
  std::string rig;
  std::string wired_as;  ///< emulated board: rig file that the emulated crane is wired by; empty: `rig`
  std::string crane;     ///< emulated board: name of a crane_emulated_rig that runs; empty: one in here
  std::uint32_t domain = 0;
};
void add_board_options(CLI::App& command, BoardOptions& options);

/// The board that a rig file names, without a stack. Only one program at a time has a board.
class OpenBoard {
 public:
  /// @throws configuration::ConfigurationError; bridge::BoardError when it is not there or in use
  explicit OpenBoard(const BoardOptions& options);
  [[nodiscard]] const configuration::Rig& rig() const { return rig_; }
  [[nodiscard]] bridge::Board& board() { return *board_; }
  /// Real time, or none where the crane is simulated in here.
  [[nodiscard]] const bring_up::Clock& clock() const { return clock_; }

 private:
  [[nodiscard]] std::unique_ptr<bridge::Board> opened(const BoardOptions& options);

  configuration::Rig rig_;
  bring_up::Clock clock_;
  bus::Bus bus_;
  runtime::Node node_;
  std::unique_ptr<bridge::Board> board_;
};

}  // namespace crane::cli
