// How long a person waits, and what the studio takes. Run by hand: test_studio "[.edit-bench]" (docs/benchmarks.md).

#include <weave/block/flip.hpp>
#include <weave/samples/samples.hpp>

#include <studio/commands/flip_stroke.hpp>
#include <studio/editors/card_editor.hpp>
#include <studio/editors/slice_editor.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/main_window.hpp>

#include <QtTest>
#include <QtWidgets>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::studio;

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void print(const char* what, std::vector<double> times) {
    std::sort(times.begin(), times.end());
    std::printf("%-44s median %6.1f ms, worst %6.1f ms of %zu\n", what, times[times.size() / 2], times.back(), times.size());
}

double resident_mb() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmRSS:", 0) == 0) return std::stod(line.substr(6)) / 1024;
    }
    return 0;
}

/// The longest that the window's thread was busy at a stretch, painting included, as an idle timer sees it.
class BusyWatch {
  public:
    BusyWatch() {
        m_timer.setInterval(0);
        QObject::connect(&m_timer, &QTimer::timeout, [this] {
            m_longest = std::max(m_longest, ms_since(m_last));
            m_last = Clock::now();
        });
        m_timer.start();
    }
    double take() {
        m_last = Clock::now();
        return std::exchange(m_longest, 0);
    }

  private:
    QTimer m_timer;
    Clock::time_point m_last = Clock::now();
    double m_longest = 0;
};

/// Until it is so, at once: a test's waiting looks only every ten milliseconds.
template <class IsSo>
void wait_until(const IsSo& is_so) {
    QTimer late;
    late.setSingleShot(true);
    late.start(30000);
    while (!is_so()) {
        REQUIRE(late.isActive());
        QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents);
    }
}

/// The next crossing round a place of the shoe that can be flipped.
class Crossings {
  public:
    explicit Crossings(const Document& document) : m_document(document) {}
    CardPlace next() {
        for (;; ++m_k) {
            REQUIRE(m_k < 4000);
            const CardPlace place{2990 + m_k % 20, 1190 + m_k / 20 % 20};
            if (flip(*m_document.shown().block, place.pick, place.end)) return ++m_k, place;
        }
    }

  private:
    const Document& m_document;
    std::size_t m_k = 0;
};

}  // namespace

TEST_CASE("from a click on a pixel of the full-size shoe to card, section and space", "[.edit-bench]") {
    const auto begun = Clock::now();
    MainWindow window;
    window.show();
    REQUIRE(QTest::qWaitForWindowExposed(&window));
    std::printf("%-44s %6.1f ms (this process: without loading libraries)\n", "a window with the start page", ms_since(begun));
    std::printf("%-44s %6.1f MB\n", "memory with the start page", resident_mb());
    window.show_sample("shoe-adult");
    Document& document = *window.document();
    wait_until([&] { return document.shown_is_current(); });
    auto* viewer = window.findChild<ViewerPanel*>();
    document.focus().go_to({3000, 1200});
    QSignalSpy shown(viewer, &ViewerPanel::model_shown);
    wait_until([&] { return !shown.isEmpty(); });
    GridCanvas& canvas = window.findChild<CardEditor*>()->canvas();
    canvas.zoom_by(60);
    QTest::qWait(1500);
    Crossings crossings(document);
    std::vector<double> card, section, space, busy;
    BusyWatch watch;
    while (card.size() < 30) {
        const CardPlace place = crossings.next();
        canvas.set_cursor_cell(GridCell{place.pick, place.end});
        QTest::qWait(60);
        shown.clear();
        watch.take();
        const auto clicked = Clock::now();
        QTest::mouseClick(&canvas, Qt::LeftButton, {}, canvas.mapping().box({place.pick, place.end}).center().toPoint());
        wait_until([&] { return document.shown_is_current(); });
        canvas.repaint();
        card.push_back(ms_since(clicked));
        wait_until([&] { return !shown.isEmpty(); });
        viewer->viewport()->repaint();
        space.push_back(ms_since(clicked));
        QTest::qWait(60);
        busy.push_back(watch.take());
    }
    auto* slices = window.findChild<SliceEditor*>();
    window.findChild<QTabWidget*>("editors")->setCurrentWidget(slices);
    QTest::qWait(1500);
    while (section.size() < 30) {
        const FlippedStroke flipped = flip_stroke(document, std::vector{crossings.next()});
        const auto clicked = Clock::now();
        REQUIRE(document.perform(flipped.step));
        wait_until([&] {
            const BlockSlices* read = slices->reader().canvas().slices();
            return document.shown_is_current() && read != nullptr && &read->block() == document.shown().block.get();
        });
        slices->reader().canvas().repaint();
        section.push_back(ms_since(clicked));
        QTest::qWait(120);
    }
    print("click to block, card painted", card);
    print("flip to section painted", section);
    print("click to planned yarns in space painted", space);
    print("window's thread busy at a stretch, painting in", busy);
    std::printf("%-44s %6.1f MB\n", "memory with the shoe", resident_mb());
}

TEST_CASE("how long unsaved work takes to be there again", "[.edit-bench]") {
    const weave::testing::TemporaryFolder folder;
    for (const std::size_t steps : {1000U, 10000U}) {
        Recovery left;
        left.base = find_sample("shoe-adult")->make();
        for (std::size_t k = 0; k < steps; ++k) left.entries.push_back(EditStep{"flip", {PutFlip{left.base.root, Flip{k % 4000, k / 4000, true}}}});
        const auto begun = Clock::now();
        const Document document(std::move(left), folder.path);
        std::printf("%-44s %8.1f ms\n", (std::to_string(steps) + " steps made again").c_str(), ms_since(begun));
    }
}
