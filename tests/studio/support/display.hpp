#pragma once

#include <sys/types.h>

namespace weave::studio::test {

/// An X server without a screen (Xvfb, OpenGL in software) for as long as this object lives. None is started where the
/// environment names a platform, or WEAVE_TEST_DISPLAY asks for the display that there is.
class Display {
  public:
    Display();
    ~Display();
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

  private:
    pid_t m_server = 0;
};

}  // namespace weave::studio::test
