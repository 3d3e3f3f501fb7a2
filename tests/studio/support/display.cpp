#include "display.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace weave::studio::test {

namespace {

/// The number that the server writes once it can be used; empty where it ended instead.
std::string read_number(int descriptor) {
    std::string number;
    for (char letter = 0; read(descriptor, &letter, 1) == 1 && letter != '\n';) number += letter;
    return number;
}

[[noreturn]] void become_server(int descriptor) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // it must not outlive a test that crashes
    const std::string where = std::to_string(descriptor);
    if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(126);
    execlp("Xvfb", "Xvfb", "-displayfd", where.c_str(), "-screen", "0", "1920x1200x24", "-nolisten", "tcp", "-noreset", nullptr);
    _exit(127);
}

}  // namespace

Display::Display() {
    if (std::getenv("QT_QPA_PLATFORM") != nullptr || std::getenv("WEAVE_TEST_DISPLAY") != nullptr) return;
    int ends[2];
    if (pipe(ends) != 0) return;
    m_server = fork();
    if (m_server == 0) {
        close(ends[0]);
        become_server(ends[1]);
    }
    close(ends[1]);
    const std::string number = read_number(ends[0]);
    close(ends[0]);
    if (number.empty()) {
        std::fputs("The tests of the studio need Xvfb (tools/install_deps)\n", stderr);
        std::_Exit(2);
    }
    setenv("DISPLAY", (":" + number).c_str(), 1);
    setenv("QT_QPA_PLATFORM", "xcb", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
}

Display::~Display() {
    if (m_server <= 0) return;
    kill(m_server, SIGTERM);
    waitpid(m_server, nullptr, 0);
}

}  // namespace weave::studio::test
