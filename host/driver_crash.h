#pragma once

namespace wale {

/// While one lives, a crash of the process (abort, bus error, segmentation fault) is taken for the OpenCL driver's, in
/// its compiler, its cache or a kernel: the program says so in one line and ends with the device's exit status.
/// PoCL 3.1 aborts when a file of its kernel cache is damaged.
class DriverCall {
 public:
  DriverCall();
  ~DriverCall();
  DriverCall(const DriverCall&) = delete;
  DriverCall& operator=(const DriverCall&) = delete;
};

}  // namespace wale
