#include "crane/plot/gnuplot.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "crane/files/complete_file.hpp"
#include "crane/recording/csv.hpp"

namespace crane::plot {
namespace {

/// A temporary script file.
class ScriptFile {
 public:
  explicit ScriptFile(const std::string& text) {
    const int descriptor = ::mkstemp(name_.data());
    const bool written = descriptor >= 0 && write_all(descriptor, text);
    const bool closed = descriptor >= 0 && ::close(descriptor) == 0;
    if (!written || !closed) throw PictureError(name_ + ": cannot write the script for gnuplot");
  }
  ~ScriptFile() { ::unlink(name_.c_str()); }
  ScriptFile(const ScriptFile&) = delete;
  ScriptFile& operator=(const ScriptFile&) = delete;
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  static bool write_all(int descriptor, const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t written = ::write(descriptor, text.data() + done, text.size() - done);
      if (written <= 0) return false;
      done += static_cast<std::size_t>(written);
    }
    return true;
  }

  std::string name_ = "/tmp/crane_picture_XXXXXX";
};

std::string terminal(const std::filesystem::path& file, double width, double height) {
  const std::string size = recording::shortest(width) + "," + recording::shortest(height);
  if (file.extension() == ".svg")
    return "set terminal svg size " + size + " font 'DejaVu Sans,14' background '#ffffff' enhanced\n";
  if (file.extension() == ".png")
    return "set terminal pngcairo size " + size + " font 'DejaVu Sans,10.5' enhanced\n";
  throw PictureError(file.string() + ": a picture's name must end in .svg or .png");
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += c;
  }
  return out + "'";
}

namespace {

/// @throws PictureError when gnuplot is missing, or with the error message of gnuplot
void run_gnuplot(const std::string& script) {
  const ScriptFile file{script};
  FILE* const pipe = ::popen(("gnuplot " + file.name() + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw PictureError("cannot start gnuplot");
  std::string said;
  std::array<char, 512> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) said += buffer.data();
  const int status = ::pclose(pipe);
  constexpr int kCommandNotFound = 127;  // exit status of the shell
  if (WIFEXITED(status) && WEXITSTATUS(status) == kCommandNotFound)
    throw PictureError("gnuplot is not installed; install it with: apt-get install gnuplot-nox");
  if (status != 0) throw PictureError("gnuplot failed: " + said);
}

}  // namespace

void draw_script(const std::filesystem::path& file, double width, double height, const std::string& script) {
  try {
    files::CompleteFile complete{file};
    run_gnuplot(terminal(file, width, height) + "set output " + quoted(complete.partial().string()) + "\n" +
                script + "unset output\n");
    complete.publish();
  } catch (const files::WriteError& error) {
    throw PictureError(error.what());
  }
}

}  // namespace crane::plot
