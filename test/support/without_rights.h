/// \file without_rights.h
/// What happens to a user who may not read or write a file: root, as tests are often run, may everything.
#pragma once

#include <cstdlib>
#include <exception>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace pcl_floam::test {

/// Runs an action in a process of its own, which if need be gives up root's rights.
/// \return the message of what it threw; "nothing thrown" if nothing
template <typename Action>
std::string thrownWithoutRights(const Action& action)
{
  constexpr unsigned kNobody = 65534;
  int ends[2];
  if (pipe(ends) != 0) {
    return "no pipe";
  }
  const pid_t child = fork();
  if (child == 0) {
    std::string message = "nothing thrown";
    if (getuid() == 0 && (setgid(kNobody) != 0 || setuid(kNobody) != 0)) {
      message = "rights cannot be given up";
    } else {
      try {
        action();
      } catch (const std::exception& error) {
        message = error.what();
      }
    }
    _exit(write(ends[1], message.data(), message.size()) < 0 ? 1 : 0);
  }
  close(ends[1]);
  std::string message(4096, '\0');
  const ssize_t length = child < 0 ? 0 : read(ends[0], message.data(), message.size());
  close(ends[0]);
  waitpid(child, nullptr, 0);
  message.resize(length < 0 ? 0 : static_cast<std::size_t>(length));
  return message;
}

}  // namespace pcl_floam::test
