#pragma once

#include <weave/core/file.hpp>
#include <weave/core/json.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <set>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

/// Runs the real program as a person's shell would, but without a shell in between.
namespace program_tests {

namespace fs = std::filesystem;

/// How a run ended.
struct Ended {
    int exit = -1;  ///< exit status; 1000 + signal where a signal ended it
    std::string out, err;

    /// What was said to people, without the lines that tell how long something takes, and those in which a program that
    /// counts its lines complains that it could not keep the counts.
    [[nodiscard]] std::vector<std::string> complaints() const {
        std::vector<std::string> lines;
        std::size_t at = 0;
        while (at < err.size()) {
            const std::size_t stop = std::min(err.find('\n', at), err.size());
            const std::string line = err.substr(at, stop - at);
            const bool progress =
                line.find(" ... ") != std::string::npos && line.substr(line.size() - 2) == " s";
            if (!progress && line.rfind("profiling:", 0) != 0) lines.push_back(line);
            at = stop + 1;
        }
        return lines;
    }
};

/// A fresh folder in which the program runs, gone at the end of the test.
class Workshop {
  public:
    Workshop() {
        std::string pattern = (fs::temp_directory_path() / "weave-program-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
        m_folder = pattern;
    }
    ~Workshop() {
        std::error_code ignored;
        fs::remove_all(m_folder, ignored);
    }
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

    [[nodiscard]] fs::path path(const std::string& name) const { return m_folder / name; }
    [[nodiscard]] bool has(const std::string& name) const { return fs::exists(path(name)); }

    /// For its owner alone, as files with secrets have to be.
    void put(const std::string& name, const std::string& bytes) const {
        REQUIRE(weave::write_file(path(name), bytes));
        fs::permissions(path(name), fs::perms::owner_read | fs::perms::owner_write);
    }
    [[nodiscard]] std::string get(const std::string& name) const {
        weave::Result<std::string> bytes = weave::read_file(path(name));
        INFO(name);
        REQUIRE(bytes);
        return *bytes;
    }

    /// All files and folders below the workshop, by their names relative to it.
    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> all;
        for (const auto& entry : fs::recursive_directory_iterator(m_folder))
            all.insert(fs::relative(entry.path(), m_folder).string());
        return all;
    }

    /// Runs `weave` with these words. `largest_file`: bytes that the program may write to one file, as on a
    /// full disk; 0: no limit.
    [[nodiscard]] Ended run(const std::vector<std::string>& words, rlim_t largest_file = 0) const {
        return start(words, largest_file).finish();
    }

    /// A run under way.
    struct Running {
        pid_t child;
        int out, err;
        Ended ended = {};

        /// Reads to the end and waits for it.
        Ended finish() {
            listen(out, err, ended);
            int status = 0;
            while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
            }
            ended.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
            return ended;
        }
        [[nodiscard]] bool is_over() const {
            siginfo_t facts{};
            return ::waitid(P_PID, static_cast<id_t>(child), &facts, WEXITED | WNOHANG | WNOWAIT) != 0 ||
                   facts.si_pid == child;
        }
        /// Waits until it has told people this, or has closed its standard error; whether it has.
        bool says(const std::string& words) {
            char buffer[4096];
            while (ended.err.find(words) == std::string::npos) {
                const ssize_t got = ::read(err, buffer, sizeof buffer);
                if (got <= 0) return false;
                ended.err.append(buffer, static_cast<std::size_t>(got));
            }
            return true;
        }
    };

    /// Starts `weave` with these words, as run() does.
    [[nodiscard]] Running start(const std::vector<std::string>& words, rlim_t largest_file = 0) const {
        return start_program(WEAVE_PROGRAM, "weave", words, largest_file);
    }

    /// The same of any program; `name` is what it is called by.
    [[nodiscard]] Running start_program(const char* program, const char* name, const std::vector<std::string>& words, rlim_t largest_file = 0) const {
        int out[2], err[2];
        if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
        std::vector<std::string> all{name};
        all.insert(all.end(), words.begin(), words.end());
        std::vector<char*> arguments;
        for (std::string& word : all) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        const pid_t child = ::fork();
        if (child < 0) throw std::runtime_error("no fork");
        if (child == 0) {
            ::dup2(out[1], STDOUT_FILENO);
            ::dup2(err[1], STDERR_FILENO);
            if (largest_file > 0) {  // a program that counts its lines must not count them into a full disk
                ::setenv("GCOV_PREFIX", "/dev/null", 1);
            }
            const rlimit limit{largest_file, largest_file};
            if (largest_file > 0 && ::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(126);
            if (::chdir(m_folder.c_str()) != 0) ::_exit(126);
            ::execv(program, arguments.data());
            ::_exit(127);
        }
        ::close(out[1]);
        ::close(err[1]);
        return {child, out[0], err[0]};
    }

    /// Runs and demands success without a complaint.
    Ended must(const std::vector<std::string>& words) const {
        Ended ended = run(words);
        INFO("weave " << joined(words));
        INFO(ended.err);
        REQUIRE(ended.exit == 0);
        CHECK(ended.complaints().empty());
        return ended;
    }

    /// Runs with --json, demands this exit status, and that standard output is one JSON object and nothing
    /// else.
    [[nodiscard]] weave::Json json(std::vector<std::string> words, int exit = 0) const {
        words.emplace_back("--json");
        const Ended ended = run(words);
        INFO("weave " << joined(words));
        INFO(ended.err);
        REQUIRE(ended.exit == exit);
        weave::Result<weave::Json> value = weave::parse_json(ended.out);
        REQUIRE(value);
        REQUIRE(value->is_object());
        return *value;
    }

    /// Runs and demands a refusal: this exit status, nothing on standard output (with --json: an object with
    /// the error), one line of complaint that holds each of these pieces. Returns the line.
    std::string refused(const std::vector<std::string>& words, int exit,
                        const std::vector<std::string>& pieces, rlim_t largest_file = 0) const {
        const std::set<std::string> before = names();
        const Ended ended = run(words, largest_file);
        INFO("weave " << joined(words));
        INFO(ended.err);
        CHECK(ended.exit == exit);
        if (std::find(words.begin(), words.end(), "--json") == words.end()) {
            CHECK(ended.out.empty());
        } else {
            const weave::Result<weave::Json> answer = weave::parse_json(ended.out);
            REQUIRE(answer);
            CHECK(answer->at("error").at("exit") == exit);
            CHECK(answer->at("error").at("message").get<std::string>().size() > 3);
        }
        const std::vector<std::string> lines = ended.complaints();
        REQUIRE(lines.size() >= 1);
        CHECK(lines.size() <= (exit == 2 ? 2U : 1U));  // usage may add where to find help
        CHECK(lines[0].rfind("weave: ", 0) == 0);
        for (const std::string& piece : pieces) {
            INFO("the line lacks: " << piece);
            CHECK(lines[0].find(piece) != std::string::npos);
        }
        CHECK(names() == before);  // nothing new, no temporary file either
        return lines[0];
    }

    static std::string joined(const std::vector<std::string>& words) {
        std::string line;
        for (const std::string& word : words) line += word + " ";
        return line;
    }

  private:
    /// Reads both pipes until the program has closed them, so that neither can fill up and stop it.
    static void listen(int out, int err, Ended& ended) {
        pollfd ends[2] = {{out, POLLIN, 0}, {err, POLLIN, 0}};
        std::string* texts[2] = {&ended.out, &ended.err};
        while (ends[0].fd >= 0 || ends[1].fd >= 0) {
            if (::poll(ends, 2, -1) < 0) continue;
            for (int k = 0; k < 2; ++k) {
                if (ends[k].fd < 0 || ends[k].revents == 0) continue;
                char buffer[4096];
                const ssize_t got = ::read(ends[k].fd, buffer, sizeof buffer);
                if (got > 0) texts[k]->append(buffer, static_cast<std::size_t>(got));
                if (got == 0) {
                    ::close(ends[k].fd);
                    ends[k].fd = -1;
                }
            }
        }
    }
    fs::path m_folder;
};

/// The shipped profile of a loom, such as `tc2`.
inline std::string loom(const std::string& name) {
    return WEAVE_SOURCE_DIR "/db/looms/" + name + ".json";
}

}  // namespace program_tests
