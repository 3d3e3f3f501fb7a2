// The main program of tests that need Slurm: where none can be started it ends with 77, which CTest counts as skipped, unless it is
// only asked which tests there are.

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <unistd.h>

namespace {

/// What keeps a cluster from being started here; empty: nothing.
std::string why_none() {
    if (::geteuid() != 0) return "a cluster of its own is started by root alone";
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch"}) {
        const std::string look = std::string("PATH=$PATH:/usr/sbin command -v ") + program + " >/dev/null";
        if (std::system(look.c_str()) != 0) return std::string(program) + " is missing (packages slurm-wlm and munge)";
    }
    return {};
}

}  // namespace

int main(int count, char** words) {
    Catch::Session session;
    if (const int wrong = session.applyCommandLine(count, words); wrong != 0) return wrong;
    const Catch::ConfigData& asked = session.configData();
    const bool only_lists = asked.listTests || asked.listTags || asked.listTestNamesOnly || asked.listReporters || asked.showHelp;
    const std::string why = why_none();
    if (!only_lists && !why.empty()) {
        std::printf("SKIPPED: %s\n", why.c_str());
        return 77;
    }
    return session.run();
}
