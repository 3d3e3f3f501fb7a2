// Pictures of the window for the guide (tests/studio/guide).

#include "screen_file.hpp"

#include <studio/panels/design_tree.hpp>
#include <studio/panels/message_bar.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/main_window.hpp>
#include <studio/window/simulation_desk.hpp>

#include <QtTest>
#include <QtWidgets>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include <support/temporary_folder.hpp>
#include "support/hands.hpp"

using namespace weave::studio;
using namespace weave::studio::test;

namespace {

void keep(QWidget& window, const char* name) {
    QTest::qWait(1500);  // pictures, not what is tested: long enough for all that is drawn in the background
    window.grab().toImage().convertToFormat(QImage::Format_RGB888).save(screen_file(QString("%1.png").arg(name)), "PNG", 0);
}

}  // namespace

TEST_CASE("screens of the guide", "[.screens]") {
    MainWindow window;
    window.resize(1600, 1000);
    window.show();
    REQUIRE(QTest::qWaitForWindowExposed(&window));
    keep(window, "start");
    window.show_sample("pocket");
    keep(window, "pocket");
    auto* editors = window.findChild<QTabWidget*>("editors");
    editors->setCurrentIndex(1);
    keep(window, "section");
    window.findChild<QDockWidget*>("submit-dock")->raise();
    keep(window, "submit");
    window.show_sample("shoe-adult");
    editors->setCurrentIndex(0);
    keep(window, "shoe");
}

TEST_CASE("screens of the docks, as wide as they come", "[.screens]") {
    MainWindow window;
    window.resize(1650, 1000);
    window.show();
    REQUIRE(QTest::qWaitForWindowExposed(&window));
    window.show_sample("plain");
    auto& simulation = *window.findChild<SimulationPanel*>();
    simulation.run_action()->trigger();
    REQUIRE(QTest::qWaitFor([&] { return simulation.state().inspection != nullptr; }, 60'000));
    auto* findings = window.findChild<QTreeWidget*>("findings");
    REQUIRE(until([&] { return findings->topLevelItemCount() > 0; }));
    findings->topLevelItem(findings->topLevelItemCount() - 1)->setExpanded(true);
    findings->scrollToBottom();
    keep(window, "dock-result");
    simulation.tabs()->setCurrentIndex(2);
    keep(window, "dock-cloth");
    for (const char* dock : {"yarns", "submit"}) {
        window.findChild<QDockWidget*>(QString("%1-dock").arg(dock))->raise();
        keep(window, (std::string("dock-") + dock).c_str());
    }
}

TEST_CASE("screens of the start page with designs of late, and of cloth that was outgrown", "[.screens]") {
    const weave::testing::TemporaryFolder folder;
    for (const char* name : {"pocket", "angle-interlock-b", "gone"}) {
        MainWindow window;
        window.show_sample(name == std::string("gone") ? "plain" : name);
        Document& document = *window.document();
        REQUIRE(until([&] { return document.shown_is_current(); }));
        document.save(QString::fromStdString((folder.path / (std::string(name) + ".weave")).string()));
        REQUIRE(until([&] { return !document.is_modified() && !document.is_saving(); }));
        keep(window, name);
    }
    std::filesystem::remove(folder.path / "gone.weave");
    const QPalette light = QApplication::palette();
    for (const char* name : {"recent", "recent-dark"}) {
        if (name == std::string("recent-dark")) QApplication::setPalette(QPalette(QColor(0x35, 0x35, 0x38), QColor(0x26, 0x26, 0x28)));
        MainWindow window;
        window.resize(1366, 768);
        window.show();
        keep(window, name);
        window.show_sample("twill-2-2");
        window.findChild<MessageBar*>("messages")->tell(MessageBar::Kind::note, SimulationDesk::tr("The cloth has another size than when it was relaxed: its relaxed yarns are gone, and the 3D view shows its plan again."),
                                                        window.findChild<SimulationPanel*>()->run_action());
        keep(window, name == std::string("recent") ? "offer" : "offer-dark");
    }
    QApplication::setPalette(light);
}
