#pragma once
/// Shared by the commands of `crane hw`: rig, board and time, used without a stack.
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
  std::string wired_as;  ///< emulated board: rig file with the wiring of the emulated crane; empty: `rig`
  /// emulated board: name of a running crane_emulated_rig; empty: emulated in this process
  std::string crane;
  std::uint32_t domain = 0;
};
void add_board_options(CLI::App& command, BoardOptions& options);

/// Opens the board of a rig file. Only one program at a time can use a board.
class OpenBoard {
 public:
  /// @throws configuration::ConfigurationError; bridge::BoardError when the board is missing or in use
  explicit OpenBoard(const BoardOptions& options);
  [[nodiscard]] const configuration::Rig& rig() const { return rig_; }
  [[nodiscard]] bridge::Board& board() { return *board_; }
  /// Real time; simulated time for a crane that is emulated in this process.
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
