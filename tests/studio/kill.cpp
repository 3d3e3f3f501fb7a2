#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>

#include <studio/commands/flip_crossing.hpp>
#include <studio/editors/card_editor.hpp>
#include <studio/window/main_window.hpp>

#include <QtTest>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::studio;

namespace {

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// One edit that a session made: when it was done, and the design that it left.
struct Made {
    static constexpr double never = 1e300;  ///< it was begun, and perhaps done
    double at = never;
    std::string sha256;
};

/// Starts this program again as a studio in which somebody edits for ever, and reads what it tells of each edit.
class EditingSession {
  public:
    explicit EditingSession(const std::filesystem::path& unsaved) {
        int ends[2];
        REQUIRE(pipe(ends) == 0);
        m_child = fork();
        REQUIRE(m_child >= 0);
        if (m_child == 0) {
            dup2(ends[1], 3);
            setenv("WEAVE_TEST_UNSAVED", unsaved.c_str(), 1);
            setenv("WEAVE_TEST_DISPLAY", "that of the test", 1);
            execl("/proc/self/exe", "test_studio", "a person who edits for ever", nullptr);
            _exit(127);
        }
        close(ends[1]);
        m_told = ends[0];
        m_reader = std::thread([this] { read_all(); });
    }
    /// Ends it as a power cut would; what it had told by then.
    std::vector<Made> kill_after(std::chrono::milliseconds time) {
        std::this_thread::sleep_for(time);
        m_killed = seconds_now();
        kill(m_child, SIGKILL);
        waitpid(m_child, nullptr, 0);
        m_reader.join();
        close(m_told);
        return m_made;
    }
    [[nodiscard]] double killed_at() const { return m_killed; }

  private:
    void read_all() {
        std::string line;
        for (char letter = 0; read(m_told, &letter, 1) == 1;) {
            if (letter != '\n') {
                line += letter;
                continue;
            }
            if (line == "done") m_made.back().at = seconds_now();
            else m_made.push_back({Made::never, line});
            line.clear();
        }
    }

    pid_t m_child = 0;
    int m_told = -1;
    double m_killed = 0;
    std::vector<Made> m_made;
    std::thread m_reader;
};

/// The hash of what there is to recover; empty where there is nothing.
std::string recovered_sha256(const std::filesystem::path& unsaved) {
    auto found = Keeper::take_recoveries(unsaved);
    if (found.empty()) return {};
    REQUIRE(found.size() == 1);
    Document document(std::move(found[0]), unsaved);
    const std::string sha256 = design_sha256(document.design());
    document.discard();
    return sha256;
}

/// Kills a session at a random moment: what is there afterwards must be the state of some edit of its last second, or later.
void kill_once(std::mt19937& random) {
    const weave::testing::TemporaryFolder folder;
    EditingSession session(folder.path);
    const std::vector<Made> made = session.kill_after(std::chrono::milliseconds(std::uniform_int_distribution(300, 2200)(random)));
    const std::string recovered = recovered_sha256(folder.path);
    std::size_t oldest = 0;  // edits up to this one are a second old: none of them may be lost
    while (oldest < made.size() && made[oldest].at < session.killed_at() - 1) ++oldest;
    INFO(made.size() << " edits, of which " << oldest << " older than a second");
    if (recovered.empty()) {
        CHECK(oldest == 0);
        return;
    }
    bool is_recent = false;
    for (std::size_t k = oldest == 0 ? 0 : oldest - 1; k < made.size(); ++k) is_recent = is_recent || made[k].sha256 == recovered;
    CHECK(is_recent);
}

}  // namespace

TEST_CASE("a person who edits for ever", "[.session]") {
    const char* unsaved = std::getenv("WEAVE_TEST_UNSAVED");
    REQUIRE(unsaved != nullptr);
    Document document(find_sample("twill-2-2")->make(), {}, true, unsaved);
    CardEditor editor;
    editor.resize(500, 500);
    editor.show_document(&document);
    editor.show();
    REQUIRE(QTest::qWaitFor([&] { return document.shown_is_current(); }, 20000));
    std::mt19937 random(static_cast<unsigned>(getpid()));
    // What each deed leads to is told before it is done, as seen on a document that nothing is kept of.
    const weave::testing::TemporaryFolder nowhere;
    Document shadow(find_sample("twill-2-2")->make(), {}, true, nowhere.path);
    const auto tell = [](const std::string& line) { return write(3, (line + "\n").data(), line.size() + 1) > 0; };
    for (;;) {
        const int deed = std::uniform_int_distribution(0, 9)(random);
        const std::size_t pick = std::uniform_int_distribution<std::size_t>(0, 3)(random), end = std::uniform_int_distribution<std::size_t>(0, 3)(random);
        if (deed == 0) shadow.undo();
        else if (deed == 1) shadow.redo();
        else if (const auto step = flip_crossing(shadow, {pick, end})) REQUIRE(shadow.perform(*step));
        if (!tell(design_sha256(shadow.design()))) return;
        if (deed == 0) document.undo();
        else if (deed == 1) document.redo();
        else QTest::mouseClick(&editor.canvas(), Qt::LeftButton, {}, editor.canvas().mapping().box({pick, end}).center().toPoint());
        REQUIRE(document.design() == shadow.design());
        tell("done");
        QTest::qWait(std::uniform_int_distribution(1, 30)(random));
    }
}

TEST_CASE("kill -9 in the middle of an editing session loses nothing that is a second old") {
    std::mt19937 random(1);
    for (int k = 0; k < 4; ++k) kill_once(random);
}

TEST_CASE("the same 100 times at random moments", "[.][long]") {
    std::mt19937 random(std::random_device{}());
    for (int k = 0; k < 100; ++k) kill_once(random);
}
