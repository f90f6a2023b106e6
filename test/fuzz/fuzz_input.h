/// \file fuzz_input.h
/// The bytes of a trial as a file, and how a broken law is told.
#pragma once

#include "support/temporary_folder.h"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace pcl_floam::test {

/// The code under test did what it must never do.
class BrokenLaw : public std::logic_error {
public:
  using std::logic_error::logic_error;
};

inline void mustHold(bool law, const char* what)
{
  if (!law) {
    throw BrokenLaw(what);
  }
}

/// Writes a trial's bytes to a file in a folder.
inline std::filesystem::path writeInput(const TemporaryFolder& folder, const char* name, const std::uint8_t* bytes,
                                        std::size_t size)
{
  return folder.write(name, std::string(reinterpret_cast<const char*>(bytes), size));
}

}  // namespace pcl_floam::test
