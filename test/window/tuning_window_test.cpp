/// Windows themselves are tested with the program `tune`, in an X server of its own:
/// test/tools/tune_test.cpp.
#include "window/tuning_window.hpp"

#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A variable of the environment, which gets its value back.
class Variable {
 public:
  explicit Variable(const char* name) : name_(name) {
    const char* value = std::getenv(name);
    before_ = value != nullptr ? std::optional<std::string>(value) : std::nullopt;
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

  /// \param value null: not set
  void set(const char* value) const {
    if (value != nullptr) {
      ::setenv(name_, value, 1);
    } else {
      ::unsetenv(name_);
    }
  }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(TuningWindow, NeedsADisplayAndSaysSo) {
  const Variable x11("DISPLAY");
  const Variable wayland("WAYLAND_DISPLAY");
  wayland.set(nullptr);
  for (const char* nothing : {static_cast<const char*>(nullptr), ""}) {
    x11.set(nothing);
    try {
      requireDisplay();
      FAIL() << "expected an error";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr("DISPLAY is not set"), HasSubstr("--screenshot FILE.png")));
    }
  }
  x11.set(":0");
  EXPECT_NO_THROW(requireDisplay());
  x11.set(nullptr);
  wayland.set("wayland-0");
  EXPECT_NO_THROW(requireDisplay());
}

}  // namespace
}  // namespace fast_edi
