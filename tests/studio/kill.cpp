#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>

#include <studio/commands/flip_crossing.hpp>
#include <studio/commands/set_title.hpp>
#include <studio/commands/tile_block.hpp>
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

/// The block that a session draws in, and the file that it saves to.
constexpr const char* drawn = "twill-2-2";

std::filesystem::path file_in(const std::filesystem::path& place) {
    return place / "mine.weave";
}

std::filesystem::path unsaved_in(const std::filesystem::path& place) {
    return place / "unsaved";
}

/// Starts this program again as a studio in which somebody edits for ever, and reads what it tells of each edit.
class EditingSession {
  public:
    EditingSession(const std::filesystem::path& place, unsigned seed) {
        int ends[2];
        REQUIRE(pipe(ends) == 0);
        m_child = fork();
        REQUIRE(m_child >= 0);
        if (m_child == 0) {
            dup2(ends[1], 3);
            setenv("WEAVE_TEST_PLACE", place.c_str(), 1);
            setenv("WEAVE_TEST_SEED", std::to_string(seed).c_str(), 1);
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

/// The hash of all that is left: what there is to recover, else what was saved; empty where there is neither.
std::string left_sha256(const std::filesystem::path& place) {
    Recoveries taken = Keeper::take_recoveries(unsaved_in(place));
    CHECK(taken.set_aside.isEmpty());
    REQUIRE(taken.found.size() <= 1);
    if (!taken.found.empty()) {
        Document document(std::move(taken.found[0]), unsaved_in(place));
        const std::string sha256 = design_sha256(document.design());
        document.discard();
        return sha256;
    }
    const auto saved = load_design(file_in(place));
    return saved ? design_sha256(*saved) : std::string();
}

/// Kills a session at a random moment: what is there afterwards must be the state of some edit of its last second, or later.
void kill_once(std::mt19937& random) {
    const weave::testing::TemporaryFolder folder;
    EditingSession session(folder.path, static_cast<unsigned>(random()));
    const std::vector<Made> made = session.kill_after(std::chrono::milliseconds(std::uniform_int_distribution(300, 2200)(random)));
    const std::string recovered = left_sha256(folder.path);
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
    const char* place = std::getenv("WEAVE_TEST_PLACE");
    const char* seed = std::getenv("WEAVE_TEST_SEED");
    REQUIRE(place != nullptr);
    REQUIRE(seed != nullptr);
    Document document(find_sample(drawn)->make(), {}, true, unsaved_in(place));
    CardEditor editor;
    editor.resize(500, 500);
    editor.show_document(&document);
    editor.show();
    REQUIRE(QTest::qWaitFor([&] { return document.shown_is_current(); }, 20000));
    std::mt19937 random(static_cast<unsigned>(std::stoul(seed)));
    const auto any = [&](int least, int most) { return std::uniform_int_distribution(least, most)(random); };
    // What each deed leads to is told before it is done, as seen on a document that nothing is kept of.
    const weave::testing::TemporaryFolder nowhere;
    Document shadow(find_sample(drawn)->make(), {}, true, nowhere.path);
    const std::string block = document.shown_block();
    const auto tell = [](const std::string& line) { return write(3, (line + "\n").data(), line.size() + 1) > 0; };
    const QString file = QString::fromStdString(file_in(place).string());
    for (int number = 1;; ++number) {
        const int deed = any(0, 11);
        const CardPlace at{static_cast<std::size_t>(any(0, 3)), static_cast<std::size_t>(any(0, 3))};
        // Each note is written once only: a design that has it is of its time and of no other.
        const EditStep note = set_title("", std::to_string(number));
        const auto [tiled, name] = [&] {
            std::string made;
            auto step = tile_block(shadow.design(), block, 2, 1, 1, made);
            REQUIRE(step);
            return std::pair(*step, made);
        }();
        const auto do_to = [&](Document& which) {
            if (deed == 0) which.undo();
            else if (deed == 1) which.redo();
            else if (deed == 2) REQUIRE(which.perform(tiled));
            else if (deed < 6) REQUIRE(which.perform(note));
        };
        do_to(shadow);
        if (deed > 6) {
            if (const auto step = flip_crossing(shadow, at)) REQUIRE(shadow.perform(*step));
        }
        if (!tell(design_sha256(shadow.design()))) return;
        do_to(document);
        if (deed == 6) document.save(file);
        if (deed > 6) QTest::mouseClick(&editor.canvas(), Qt::LeftButton, {}, editor.canvas().mapping().box({at.pick, at.end}).center().toPoint());
        REQUIRE(document.design() == shadow.design());
        tell("done");
        QTest::qWait(any(1, 30));
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
