// The main program of tests that need a device: without one it ends with 77, which CTest counts as skipped, unless it is only
// asked which tests there are.

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include <weave/sim/device/devices.hpp>

#include <cstdio>

int main(int count, char** words) {
    Catch::Session session;
    if (const int wrong = session.applyCommandLine(count, words); wrong != 0) return wrong;
    const Catch::ConfigData& asked = session.configData();
    const bool only_lists = asked.listTests || asked.listTags || asked.listTestNamesOnly || asked.listReporters || asked.showHelp;
    const weave::sim::Devices found = weave::sim::devices();
    if (!only_lists && !found.why_none.empty()) {
        std::printf("SKIPPED: %s\n", found.why_none.c_str());
        return 77;
    }
    return session.run();
}
