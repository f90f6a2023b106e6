#include "interruption.h"

#include <csignal>

namespace pcl_floam::tools {

namespace {

volatile std::sig_atomic_t received_signal = 0;

extern "C" void noteSignal(int signal)
{
  received_signal = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void noteInterruptions()
{
  std::signal(SIGINT, noteSignal);
  std::signal(SIGTERM, noteSignal);
}

int interruptedBy()
{
  return received_signal;
}

}  // namespace pcl_floam::tools
