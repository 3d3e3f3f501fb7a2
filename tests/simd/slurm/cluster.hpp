#pragma once

#include "../box.hpp"
#include "../results.hpp"
#include "../submitted.hpp"

#include <weave/core/file.hpp>

#include <catch2/catch.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <support/temporary_folder.hpp>
#include <vector>

namespace weave::simd::testing {

/// What a command of the shell tells, without what it tells people.
inline std::string told_by(const std::string& command) {
    std::string text;
    FILE* const pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
    REQUIRE(pipe != nullptr);
    for (int c = 0; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
    ::pclose(pipe);
    return text;
}

/// A cluster of Slurm on this machine: two nodes with a GPU each, which is none. Programs that are started while it lives know of it.
class Cluster {
  public:
    Cluster() {
        const std::string conf = run("start");
        INFO(conf << told());
        REQUIRE(conf.find("slurm.conf") != std::string::npos);
        ::setenv("SLURM_CONF", (m_folder.path / "slurm.conf").c_str(), 1);
    }
    ~Cluster() {
        ::unsetenv("SLURM_CONF");
        run("stop");
    }
    Cluster(const Cluster&) = delete;
    Cluster& operator=(const Cluster&) = delete;

    /// munged, slurmctld, n1 or n2.
    [[nodiscard]] pid_t process(const std::string& daemon) const {
        const auto text = read_file(m_folder.path / (daemon + ".pid"));
        REQUIRE(text);
        return static_cast<pid_t>(std::stol(*text));
    }
    void signal(const std::string& daemon, int what) const { ::kill(process(daemon), what); }
    void start_again(const std::string& daemon) const { run("again", daemon); }

    /// The folder that all nodes share.
    [[nodiscard]] std::filesystem::path shared() const { return m_folder.path / "shared"; }
    [[nodiscard]] std::filesystem::path folder() const { return m_folder.path; }
    /// Of a daemon's configuration, looking at the queue as often as it can.
    [[nodiscard]] Json config(Json more = Json::object()) const {
        Json slurm{{"folder", shared().string()}, {"watch_seconds", 1}, {"checkpoint_seconds", 1}, {"gres", "gpu:1"}};
        slurm.update(more);
        return Json{{"slurm", slurm}};
    }
    /// Lines of the queue, of jobs that ended lately too: `4711|0|name|RUNNING|n1|comment`.
    [[nodiscard]] std::vector<std::string> queue() const {
        std::vector<std::string> lines;
        std::string text = told_by("squeue --me --array --noheader --states=all --format='%F|%K|%j|%T|%N|%k'");
        while (!text.empty()) {
            lines.push_back(text.substr(0, text.find('\n')));
            text.erase(0, lines.back().size() + 1);
        }
        return lines;
    }
    /// How many of its lines have this in them.
    [[nodiscard]] std::size_t queued(const std::string& part) const {
        std::size_t found = 0;
        for (const std::string& line : queue()) found += line.find(part) != std::string::npos ? 1 : 0;
        return found;
    }
    /// The processes of `simd job` that are at work on its nodes, or elsewhere for its jobs.
    [[nodiscard]] std::vector<pid_t> copies() const {
        std::vector<pid_t> found;
        const std::string arrays = (shared() / "arrays").string();
        for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
            const std::string name = entry.path().filename().string();
            if (name.find_first_not_of("0123456789") != std::string::npos) continue;
            std::ifstream file(entry.path() / "cmdline");
            const std::string words((std::istreambuf_iterator<char>(file)), {});
            if (words.find("simd" + std::string(1, '\0') + "job" + '\0' + arrays) != std::string::npos) found.push_back(std::stoi(name));
        }
        return found;
    }
    [[nodiscard]] std::string told() const {
        std::string text;
        for (const char* log : {"told", "slurmctld.log", "n1.log", "n2.log"}) {
            if (const auto read = read_file(m_folder.path / log)) text += std::string(log) + ":\n" + *read;
        }
        return text;
    }

  private:
    std::string run(const std::string& what, const std::string& more = {}) const {
        return told_by(std::string(WEAVE_SOURCE_DIR) + "/tests/simd/slurm/cluster " + what + " '" + (m_folder.path).string() + "' " + more);
    }
    weave::testing::TemporaryFolder m_folder;
};

/// A run of long_cloth that is caught in the act: it outlasts by far a look of the daemon, a checkpoint and Slurm's own way of putting a job back,
/// a second each, also on a machine several times as quick. It does come to rest, so that its bits can be compared. Under sanitizers, which are
/// ten times as slow, the quicker run lasts as long.
inline wire::Simulation lasting_run() {
    if (is_sanitized) return long_run();
    wire::Simulation simulation;
    simulation.plan.fidelity = sim::Fidelity::reference;
    simulation.plan.reduce = false;
    simulation.residual = 1e-4;
    return simulation;
}

/// The yarns of such a run of the long cloth as a daemon of this machine makes them, without Slurm.
inline std::string yarns_made_here(const wire::Simulation& simulation) {
    const Box here;
    wire::Follower follower = here.follower();
    const std::uint64_t job = submit(follower, document_of(long_cloth), simulation);
    REQUIRE(end_of(follower, job).phase == wire::JobPhase::done);
    return yarns_of(follower, job);
}

/// Waits until something is so; whether it came to that.
inline bool until(const std::function<bool()>& is_so, std::chrono::milliseconds patience = 60s) {
    const auto late = std::chrono::steady_clock::now() + patience;
    while (!is_so()) {
        if (std::chrono::steady_clock::now() > late) return false;
        std::this_thread::sleep_for(50ms);
    }
    return true;
}

}  // namespace weave::simd::testing
