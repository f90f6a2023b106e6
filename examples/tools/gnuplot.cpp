#include "gnuplot.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace pcl_floam::tools {

namespace {

/// A file with a script, deleted at the end.
class ScriptFile {
public:
  explicit ScriptFile(const std::string& script)
  {
    std::error_code error;
    path_ = (std::filesystem::temp_directory_path(error) / "pcl_floam_plot_XXXXXX").string();
    const int file = error ? -1 : mkstemp(path_.data());
    if (file < 0) {
      return;
    }
    std::size_t written = 0;
    while (written < script.size()) {
      const ssize_t count = ::write(file, script.data() + written, script.size() - written);
      if (count <= 0) {
        break;
      }
      written += static_cast<std::size_t>(count);
    }
    complete_ = ::close(file) == 0 && written == script.size();
  }
  ~ScriptFile() { ::unlink(path_.c_str()); }
  ScriptFile(const ScriptFile&) = delete;
  ScriptFile& operator=(const ScriptFile&) = delete;

  [[nodiscard]] bool isComplete() const { return complete_; }
  [[nodiscard]] std::string& path() { return path_; }

private:
  std::string path_;
  bool complete_ = false;
};

/// Starts gnuplot without a shell, silenced. \return 0 or the error number
int startGnuplot(std::string& script_path, pid_t& process)
{
  std::string name = "gnuplot";
  char* arguments[] = {name.data(), script_path.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  const int error = posix_spawnp(&process, name.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

std::string runGnuplot(const std::string& script)
{
  ScriptFile file(script);
  if (!file.isComplete()) {
    return "its script cannot be written to the folder for temporary files";
  }
  pid_t process = 0;
  const int error = startGnuplot(file.path(), process);
  if (error != 0) {
    return error == ENOENT ? "gnuplot is not installed (package gnuplot-nox)" : std::strerror(error);
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    return "gnuplot cannot be started";
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? std::string() : "gnuplot failed";
}

}  // namespace pcl_floam::tools
