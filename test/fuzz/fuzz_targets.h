/// \file fuzz_targets.h
/// What reads foreign bytes, one function each: libFuzzer feeds them, and the tests replay the kept corpus.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pcl_floam::test {

/// Takes any bytes. Throws \ref BrokenLaw, or whatever the code under test must not throw.
using FuzzTarget = void (*)(const std::uint8_t* bytes, std::size_t size);

void fuzzPcd(const std::uint8_t* bytes, std::size_t size);              ///< a .pcd scan, and what becomes of it
void fuzzKittiBin(const std::uint8_t* bytes, std::size_t size);         ///< a .bin scan, and what becomes of it
void fuzzPoses(const std::uint8_t* bytes, std::size_t size);            ///< a trajectory, KITTI's or TUM's
void fuzzTimes(const std::uint8_t* bytes, std::size_t size);            ///< times.txt of three scans
void fuzzMap(const std::uint8_t* bytes, std::size_t size);              ///< both layers of a saved map
void fuzzRecording(const std::uint8_t* bytes, std::size_t size);        ///< a bag, an mcap or a capture, and its scans
void fuzzScanMessage(const std::uint8_t* bytes, std::size_t size);      ///< a message; the first byte tells its type
void fuzzCalibration(const std::uint8_t* bytes, std::size_t size);      ///< of an HDL-64, and a scan decoded by it
void fuzzOdometryOptions(const std::uint8_t* bytes, std::size_t size);  ///< arguments of the tool, one a line

}  // namespace pcl_floam::test
