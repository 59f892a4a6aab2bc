#pragma once

#include <memory>
#include <string>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "scene/error.h"

namespace airlight::reference {

/// An Embree device that turns Embree's errors into ours.
class EmbreeDevice {
 public:
  /// @throws scene::Error (driver)
  EmbreeDevice() : device_(rtcNewDevice(nullptr)), message_(std::make_unique<std::string>()) {
    if (!device_) fail(fmt::format("no device, error {}", static_cast<int>(rtcGetDeviceError(nullptr))));
    rtcSetDeviceErrorFunction(
        device_,
        [](void* message, RTCError code, const char* text) {
          *static_cast<std::string*>(message) =
              fmt::format("error {}: {}", static_cast<int>(code), text ? text : "");
        },
        message_.get());
  }
  ~EmbreeDevice() { rtcReleaseDevice(device_); }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_; }

  /// @throws scene::Error (driver) where a call has failed since the last check
  void check() const {
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) fail(*message_);
  }

 private:
  [[noreturn]] static void fail(const std::string& problem) {
    throw scene::Error(scene::ExitCode::driver, "Embree", problem, "give it more memory or a smaller scene");
  }

  RTCDevice device_;
  std::unique_ptr<std::string> message_;  ///< Embree's last
};

}  // namespace airlight::reference
