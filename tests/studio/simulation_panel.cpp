// The simulation panel, by mouse and keys.

#include "screen_file.hpp"

#include <studio/panels/simulation_panel.hpp>

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/sim/yarns_file.hpp>

#include <QtTest>
#include <QtWidgets>

#include <catch2/catch.hpp>

#include <studio/panels/simulation_backend_row.hpp>
#include <studio/panels/simulation_fidelity_group.hpp>
#include <studio/panels/simulation_findings.hpp>
#include <studio/panels/message_bar.hpp>
#include <studio/panels/plain_tip.hpp>
#include <studio/panels/simulation_parameter_row.hpp>
#include <studio/panels/simulation_region_group.hpp>
#include <studio/panels/simulation_residual_plot.hpp>
#include <studio/panels/simulation_scene_group.hpp>
#include <studio/panels/simulation_servers.hpp>
#include <studio/panels/simulation_system_group.hpp>
#include <studio/support/follow_run.hpp>
#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

/// Settings of the test alone, which go away with it.
class OwnSettings {
  public:
    OwnSettings() {
        QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope,
                           QString::fromStdString(m_folder.path.string()));
        QCoreApplication::setOrganizationName("weave-test");
        QCoreApplication::setApplicationName("studio-test");
        QSettings().clear();
    }

  private:
    weave::testing::TemporaryFolder m_folder;
};

/// A panel with its window, and what it tells.
class Shown {
  public:
    explicit Shown(const Design& design, bool follows = true) : m_design(design) {
        window.setCentralWidget(panel);
        QObject::connect(panel, &SimulationPanel::scene_edited, &window,
                         [this, follows](const Scene& scene, bool is_dragging) {
                             edits.push_back({scene, is_dragging});
                             m_design.scene = scene;
                             if (follows) panel->set_design(m_design);  // as the owner of the document does
                         });
        QObject::connect(panel, &SimulationPanel::place_wanted, &window,
                         [this](std::size_t pick, std::size_t end) {
                             place = ClothPlace{pick, end};
                         });
        QObject::connect(panel, &SimulationPanel::laid_out, &window, [this] { ++layouts; });
        QObject::connect(panel, &SimulationPanel::frame_came, &window, [this] { ++frames; });
        QObject::connect(panel, &SimulationPanel::yarns_came, &window,
                         [this](const auto& one) { yarns = one; });
        panel->set_design(design);
        window.resize(480, 1000);
        window.show();
        REQUIRE(QTest::qWaitForWindowExposed(&window));
        QApplication::setActiveWindow(
            &window);  // there is nobody else who would: shortcuts are of the active window
    }
    [[nodiscard]] bool until(const std::function<bool()>& enough) const {
        const bool came = QTest::qWaitFor(enough, patience_ms);
        if (!came)
            UNSCOPED_INFO(panel->sentence()->text().toStdString()
                          << "; " << panel->message_bar()->words().toStdString());
        return came;
    }
    [[nodiscard]] bool until_phase(RunPhase phase) const {
        return until([&] { return panel->state().phase == phase; });
    }
    [[nodiscard]] bool until_inspected() const {
        return until([&] { return panel->state().inspection != nullptr; });
    }
    [[nodiscard]] QToolButton* button(const QAction* action) const {
        for (auto* one : panel->findChildren<QToolButton*>()) {
            if (one->defaultAction() == action) return one;
        }
        FAIL("there is no such button");
        return nullptr;
    }
    void press(const QAction* action) const { QTest::mouseClick(button(action), Qt::LeftButton); }

    QMainWindow window;
    SimulationPanel* panel = new SimulationPanel;
    struct SceneEdit {
        Scene scene;
        bool is_dragging;
    };
    std::vector<SceneEdit> edits;
    std::optional<ClothPlace> place;
    std::shared_ptr<const Yarns> yarns;
    std::size_t layouts = 0, frames = 0;
    [[nodiscard]] const Design& design() const { return m_design; }

  private:
    Design m_design;
};

void set_spin(QDoubleSpinBox* box, const QString& text) {
    box->setFocus();
    box->selectAll();
    QTest::keyClicks(box, text);
    QTest::keyClick(box, Qt::Key_Return);
}

}  // namespace

TEST_CASE("the simulation panel runs a cloth to rest by its button, and tells what it shows") {
    const OwnSettings settings;
    Shown shown(sample("angle-interlock-b"));
    SimulationPanel& panel = *shown.panel;
    CHECK(panel.sentence()->text() == "Not simulated yet");
    CHECK_FALSE(panel.stop_action()->isEnabled());
    CHECK_FALSE(panel.save_action()->isEnabled());
    shown.press(panel.run_action());
    REQUIRE(shown.until_inspected());
    CHECK(panel.state().phase == RunPhase::at_rest);
    CHECK(panel.sentence()->text().startsWith("At rest within 0.01 after"));
    CHECK(shown.layouts == 1);
    CHECK(shown.frames > 0);
    CHECK(shown.yarns);
    CHECK(panel.plot()->points().size() > 50);
    CHECK(panel.findings()->plan()->childCount() > 8);
    CHECK(panel.findings()->inspection()->childCount() > 3);
    CHECK_FALSE(panel.run_action()->isEnabled());
    CHECK(panel.save_action()->isEnabled());
    // A line that speaks of a place leads there.
    QTreeWidgetItem* line = nullptr;
    for (int k = 0; k < panel.findings()->inspection()->childCount(); ++k) {
        auto* one = panel.findings()->inspection()->child(k);
        if (one->data(0, Qt::UserRole).isValid() && line == nullptr) line = one;
    }
    REQUIRE(line != nullptr);
    panel.findings()->scrollToItem(line);
    QTest::mouseClick(panel.findings()->viewport(), Qt::LeftButton, {},
                      panel.findings()->visualItemRect(line).center());
    REQUIRE(shown.place);
    CHECK(shown.place->pick == line->data(0, Qt::UserRole).toULongLong());
    shown.press(panel.again_action());
    CHECK(panel.state().inspection == nullptr);
    REQUIRE(shown.until_inspected());
    CHECK(shown.layouts == 2);
}

TEST_CASE("Space runs and pauses the simulation panel, and is left to what has the focus") {
    const OwnSettings settings;
    Shown shown(sample("hexagon-tubes"));
    SimulationPanel& panel = *shown.panel;
    panel.fidelity()->choice()->setCurrentIndex(2);
    panel.plot()->setFocus();
    QTest::keyClick(panel.plot(), Qt::Key_Space);
    REQUIRE(shown.until([&] { return panel.state().progress.step > 3; }));
    CHECK(panel.run_action()->text() == "Pause");
    QTest::keyClick(panel.plot(), Qt::Key_Space);
    REQUIRE(shown.until([&] { return panel.state().phase == RunPhase::paused && panel.state().yarns; }));
    CHECK(panel.run_action()->text() == "Go on");
    CHECK(panel.sentence()->text().startsWith("Paused after"));
    const std::uint64_t before = panel.state().progress.step;
    shown.press(panel.step_action());
    REQUIRE(shown.until([&] {
        return panel.state().phase == RunPhase::paused && panel.state().progress.step == before + 1;
    }));
    panel.tabs()->setCurrentIndex(2);
    panel.scene()->gravity()->setFocus();
    QTest::keyClick(panel.scene()->gravity(), Qt::Key_Space);
    CHECK(panel.scene()->gravity()->isChecked());
    CHECK(panel.state().phase == RunPhase::paused);
    REQUIRE(shown.edits.size() == 1);
    CHECK(shown.edits.back().scene.gravity);
    CHECK(panel.is_out_of_date());
    shown.press(panel.stop_action());
    REQUIRE(shown.until_phase(RunPhase::stopped));
    CHECK(panel.sentence()->text().startsWith("Stopped after"));
}

TEST_CASE(
    "parameters changed in the simulation panel are led in while it runs, and are edits of the design") {
    const OwnSettings settings;
    Shown shown(sample("plain"));
    SimulationPanel& panel = *shown.panel;
    shown.press(panel.run_action());
    REQUIRE(shown.until_inspected());
    const double before = shown.yarns->yarns.back().radius_mm;
    REQUIRE(shown.yarns->yarns.back().system == System::warp);
    panel.tabs()->setCurrentIndex(1);
    set_spin(panel.warp()->radius()->spin_box(), "1.2");
    REQUIRE(shown.edits.size() == 1);
    CHECK(shown.edits.back().scene.warp.radius_scale == 1.2);
    CHECK_FALSE(shown.edits.back().is_dragging);
    REQUIRE(shown.until(
        [&] { return shown.yarns->yarns.back().radius_mm > 1.1 * before && panel.state().inspection; }));
    CHECK(shown.yarns->yarns.back().radius_mm == Approx(1.2 * before));
    CHECK_FALSE(panel.is_out_of_date());
    // A slider that is held is one edit for the undo list.
    shown.edits.clear();
    QSlider* slider = panel.warp()->strain()->slider();
    QStyleOptionSlider option;
    option.initFrom(slider);
    option.orientation = Qt::Horizontal;
    option.minimum = slider->minimum();
    option.maximum = slider->maximum();
    option.sliderPosition = option.sliderValue = slider->sliderPosition();
    const QPoint handle =
        slider->style()->subControlRect(QStyle::CC_Slider, &option, QStyle::SC_SliderHandle, slider).center();
    QTest::mousePress(slider, Qt::LeftButton, {}, handle);
    QTest::mouseMove(slider, handle + QPoint(20, 0));
    QTest::mouseMove(slider, handle + QPoint(40, 0));
    REQUIRE(shown.edits.size() >= 2);
    for (const auto& edit : shown.edits) CHECK(edit.is_dragging);
    QTest::mouseRelease(slider, Qt::LeftButton, {}, handle + QPoint(40, 0));
    CHECK_FALSE(shown.edits.back().is_dragging);
    CHECK(*shown.edits.back().scene.warp.strain > 1.01);
    CHECK(*shown.edits.back().scene.warp.strain <= 1.5);
    REQUIRE(shown.until_inspected());
    // Undone by the owner: back to what it was.
    Design plain = sample("plain");
    panel.set_design(plain);
    CHECK(panel.warp()->strain()->value() == Approx(1.0));
    REQUIRE(shown.until(
        [&] { return shown.yarns->yarns.back().radius_mm == Approx(before) && panel.state().inspection; }));
}

TEST_CASE(
    "the simulation panel asks for ranges that cannot break the solver, and shows what a document has beyond "
    "them") {
    const OwnSettings settings;
    Design design = sample("plain");
    design.scene.warp.radius_scale = 3;
    design.scene.weft.stiffness_scale = 2;
    Shown shown(design);
    const SystemGroup& warp = *shown.panel->warp();
    CHECK(warp.radius()->value() == 3);
    CHECK(warp.strain()->spin_box()->maximum() == 50);
    CHECK(warp.stiffness()->spin_box()->minimum() == 0.001);
    CHECK(warp.radius()->toolTip().contains("0.5 to 1.5"));
    CHECK(warp.is_fed() == nullptr);
    CHECK(shown.panel->weft()->stiffness()->value() == 2);
    CHECK_FALSE(shown.panel->weft()->strain()->isEnabled());
    CHECK(shown.edits.empty());  // to show something is no edit
    shown.panel->tabs()->setCurrentIndex(1);
    QTest::mouseClick(shown.panel->weft()->is_fed(), Qt::LeftButton, {},
                      {8, shown.panel->weft()->is_fed()->height() / 2});
    REQUIRE(shown.edits.size() == 1);
    CHECK(shown.edits.back().scene.weft.strain == 1.01);
    CHECK(shown.edits.back().scene.warp.radius_scale == 3);
    CHECK(shown.panel->weft()->strain()->isEnabled());
}

TEST_CASE("a part of the cloth is what the simulation panel simulates when that is chosen") {
    const OwnSettings settings;
    Shown shown(sample("satin-e"));
    SimulationPanel& panel = *shown.panel;
    panel.set_cloth(BlockGrid(std::vector<std::uint32_t>(10, 1), std::vector<std::uint32_t>(5, 1)));
    panel.tabs()->setCurrentIndex(2);
    QTest::mouseClick(panel.region()->part(), Qt::LeftButton, {}, {8, panel.region()->part()->height() / 2});
    CHECK(panel.region()->last_row()->maximum() == 10);
    CHECK(panel.region()->last_column()->value() == 5);
    panel.region()->first_row()->setValue(2);
    CHECK(panel.region()->last_row()->value() >= 4);
    panel.region()->last_row()->setValue(3);  // fewer than three rows cannot move
    CHECK(panel.region()->last_row()->value() == 4);
    panel.region()->first_column()->setValue(2);
    panel.region()->last_column()->setValue(4);
    CHECK(panel.region()->region() == Region{1, 3, 1, 3});
    shown.press(panel.run_action());
    REQUIRE(shown.until_inspected());
    CHECK(shown.yarns->region == Region{1, 3, 1, 3});
    QTest::mouseClick(panel.region()->whole(), Qt::LeftButton, {},
                      {8, panel.region()->whole()->height() / 2});
    CHECK_FALSE(panel.region()->region());
}

TEST_CASE("a run at rest or paused that no longer shows the design says so, and starts anew by Run and by Step") {
    const OwnSettings settings;
    Shown shown(sample("plain"));
    SimulationPanel& panel = *shown.panel;
    std::vector<bool> dated;
    QObject::connect(&panel, &SimulationPanel::dated_changed, &panel, [&](bool is_dated) { dated.push_back(is_dated); });
    shown.press(panel.run_action());
    REQUIRE(shown.until_inspected());
    CHECK_FALSE(panel.run_action()->isEnabled());
    auto* bar = panel.findChild<QProgressBar*>();
    CHECK(bar->format() == "at rest");
    panel.tabs()->setCurrentIndex(2);
    panel.scene()->gravity()->click();
    REQUIRE(panel.is_out_of_date());
    CHECK(panel.sentence()->text().startsWith("The design before the change: At rest"));
    CHECK(bar->format() == "the design has changed");
    CHECK(bar->value() == 0);
    CHECK(panel.step_action()->isEnabled());
    shown.press(panel.run_action());
    CHECK(panel.state().inspection == nullptr);
    REQUIRE(shown.until_inspected());
    CHECK(shown.layouts == 2);
    CHECK(panel.sentence()->text().startsWith("At rest"));
    CHECK(shown.yarns->scene_sha256 == scene_sha256(shown.design()));
    panel.scene()->gravity()->click();
    shown.press(panel.step_action());
    REQUIRE(shown.until([&] { return panel.state().phase == RunPhase::paused && panel.state().progress.step == 1; }));
    CHECK(shown.layouts == 3);
    CHECK(panel.run_action()->text() == "Go on");
    panel.scene()->gravity()->click();
    CHECK(panel.run_action()->text() == "Run");
    CHECK(dated == std::vector{true, false, true, false, true});
}

TEST_CASE("a figure that has more places than its box shows keeps them when something else is edited") {
    const OwnSettings settings;
    Design design = sample("plain");
    design.scene.friction = 0.125;
    Shown shown(design);
    shown.panel->tabs()->setCurrentIndex(2);
    shown.panel->scene()->gravity()->click();
    REQUIRE(shown.edits.size() == 1);
    CHECK(shown.edits.back().scene.friction == 0.125);
    set_spin(shown.panel->scene()->friction()->spin_box(), "0.3");
    CHECK(shown.edits.back().scene.friction == 0.3);
}

TEST_CASE("the words of a server are shown as they are in the simulation panel") {
    const OwnSettings settings;
    Shown shown(sample("plain"));
    CHECK(shown.panel->sentence()->textFormat() == Qt::PlainText);
    CHECK(plain_tip("a<b>c\nd") == "<qt>a&lt;b&gt;c<br>d</qt>");
}

TEST_CASE("yarns of the simulation panel are saved and opened, and what goes wrong is told in words") {
    const OwnSettings settings;
    const weave::testing::TemporaryFolder folder;
    const auto in_folder = [&](const char* name) {
        return QString::fromStdString((folder.path / name).string());
    };
    Shown shown(sample("plain"));
    SimulationPanel& panel = *shown.panel;
    shown.press(panel.run_action());
    REQUIRE(shown.until_inspected());
    for (const char* name : {"cloth.yarns", "cloth.vtp", "cloth.obj"}) {
        panel.message_bar()->clear();
        panel.save_to(in_folder(name));
        REQUIRE(shown.until([&] { return panel.message_bar()->words().contains("Saved"); }));
        CHECK(std::filesystem::file_size(folder.path / name) > 1000);
    }
    check_same(read_yarns(read_file(folder.path / "cloth.yarns").value()).value(), *shown.yarns);
    panel.save_to(in_folder("cloth.png"));
    REQUIRE(shown.until([&] { return panel.message_bar()->kind() == MessageBar::Kind::error; }));
    CHECK(panel.message_bar()->words().contains(".vtp or .obj"));
    CHECK(panel.message_bar()->isVisible());
    shown.yarns.reset();
    panel.open(in_folder("cloth.yarns"));
    REQUIRE(shown.until([&] { return shown.yarns != nullptr; }));
    panel.open(in_folder("none.yarns"));
    REQUIRE(shown.until([&] { return panel.message_bar()->words().contains("none.yarns"); }));
    QTest::mouseClick(panel.message_bar()->findChild<QToolButton*>("close-message"), Qt::LeftButton);
    CHECK_FALSE(panel.message_bar()->isVisible());
}

TEST_CASE(
    "a design that the simulator refuses, and a server that is not there, show in the simulation panel") {
    const OwnSettings settings;
    Design design = sample("plain");
    design.scene.boundary_x = Boundary::free;
    Shown shown(design);
    SimulationPanel& panel = *shown.panel;
    shown.press(panel.run_action());
    REQUIRE(shown.until_phase(RunPhase::failed));
    REQUIRE(shown.until([&] { return panel.sentence()->text().contains("fed at constant tension"); }));
    CHECK(panel.run_action()->isEnabled());
    panel.set_design(sample("plain"));
    panel.backend()->set_servers({{"unix:/nowhere/simd.sock", "", ""}});
    panel.backend()->choice()->setCurrentIndex(1);
    shown.press(panel.run_action());
    REQUIRE(shown.until([&] { return panel.state().phase == RunPhase::failed && panel.state().error; }));
    CHECK(panel.sentence()->text().contains("nowhere"));
    panel.backend()->choice()->setCurrentIndex(0);
    shown.press(panel.run_action());
    REQUIRE(shown.until_inspected());
}

TEST_CASE("servers and the fidelity are remembered, a token's file by its name alone") {
    const OwnSettings settings;
    ServersDialog dialog({{"box", "/home/dora/token", ""}});
    dialog.add({"  unix:/run/simd.sock ", "", ""});
    dialog.add({"", "x", ""});  // no place, no server
    const std::vector<ServerWish> servers = dialog.servers();
    REQUIRE(servers.size() == 2);
    CHECK(servers[1].host == "unix:/run/simd.sock");
    remember_servers(servers);
    CHECK(remembered_servers() == servers);
    {
        BackendRow row;
        CHECK_FALSE(row.server());
        REQUIRE(row.choice()->count() == 3);
        row.choice()->setCurrentIndex(1);
        FidelityGroup fidelity;
        fidelity.choice()->setCurrentIndex(1);
        fidelity.draft_first()->setChecked(true);
    }
    const BackendRow row;
    REQUIRE(row.server());
    CHECK(row.server()->token_file == "/home/dora/token");
    const FidelityGroup fidelity;
    CHECK(fidelity.fidelity() == sim::Fidelity::standard);
    CHECK(fidelity.start_from() == sim::Fidelity::draft);
}

TEST_CASE("a simulation server is tested from the list of servers, and an empty place shows what one looks like") {
    const OwnSettings settings;
    ServersDialog dialog({{"unix:/nowhere/simd.sock", "", ""}});
    dialog.show();
    REQUIRE(QTest::qWaitForWindowExposed(&dialog));
    dialog.table()->setCurrentCell(0, 0);
    QTest::mouseClick(dialog.findChild<QPushButton*>("test_server"), Qt::LeftButton);
    const auto* answer = dialog.findChild<QLabel*>("server_answer");
    REQUIRE(QTest::qWaitFor([&] { return answer->text().contains("nowhere") && !answer->text().startsWith("Asking"); }, patience_ms));
    dialog.add({});
    dialog.table()->setCurrentCell(1, 0);
    dialog.table()->editItem(dialog.table()->currentItem());
    REQUIRE(dialog.table()->findChild<QLineEdit*>());
    CHECK(dialog.table()->findChild<QLineEdit*>()->placeholderText().contains("box:8444"));
}

TEST_CASE("the signs of run, step and stop are in the colour of the text in the simulation panel") {
    const OwnSettings settings;
    Shown shown(sample("plain"));
    QPalette dark;
    dark.setColor(QPalette::Window, QColor(45, 45, 48));
    dark.setColor(QPalette::ButtonText, Qt::white);
    shown.panel->setPalette(dark);
    const QImage sign = shown.panel->run_action()->icon().pixmap(64, 64).toImage();
    CHECK(sign.pixelColor(sign.width() / 2, sign.height() / 2) == QColor(Qt::white));
}

TEST_CASE("figures of each fidelity stand in the documents that they name") {
    const auto document = [](const char* name) {
        return read_file(std::filesystem::path(WEAVE_SOURCE_DIR) / name).value();
    };
    const std::string summary = document("docs/simulation.md"), table = document("docs/tradeoff.md") + document("docs/tradeoff/tradeoff.md");
    CHECK_THAT(summary, Catch::Contains("after 15 to 58 % of its time") && Catch::Contains("0.3 to 1.4 times the work"));
    // Median and most of the errors: crimp, thickness.
    CHECK_THAT(table,
               Catch::Contains("| draft | as one gets it | 18 | 0.179 | 7.017 (orthogonal) | 1.71 | 21.54 (angle-interlock-a) |") &&
                   Catch::Contains("| standard | as one gets it | 18 | 0.013 | 1.438 (orthogonal) | 0.10 | 1.50 (orthogonal) |") &&
                   Catch::Contains("| reference | as one gets it | 18 | 0.001 | 0.081 (plain-pinned) | 0.00 | 0.23 (orthogonal) |"));
    // The cloths that took longest of those that come to rest, and most points.
    CHECK_THAT(table, Catch::Contains("| tl013-wrong | 3840 | 1.43 | 0.193 | 2.52 | 0.013 | 10.93 | 0.000 |") && Catch::Contains("| tl013-corrected | 3840 | 1.41 | 0.229 | 3.15 | 0.014 | 10.59 | 0.000 |") &&
                          Catch::Contains("| draft | relax | plan | 16 |") && Catch::Contains("| draft | relax | plan | 1920 |") &&
                          Catch::Contains("| reference | relax | standard | 7680 |"));
    const auto told = [](sim::Fidelity fidelity) { return words_of(fidelity).words.toStdString() + words_of(fidelity).source.toStdString(); };
    CHECK_THAT(told(sim::Fidelity::draft), Catch::Contains("tradeoff.md") && Catch::Contains("0.2 points as a rule and 7 at most") && Catch::Contains("up to 22 %") &&
                                               Catch::Contains("0.179 and 7.017") && Catch::Contains("1.71 and 21.54 %") && Catch::Contains("up to 1.4 s"));
    CHECK_THAT(told(sim::Fidelity::standard), Catch::Contains("0.01 points as a rule and 1.4 at most") && Catch::Contains("up to 1.5 %") &&
                                                  Catch::Contains("0.013 and 1.438") && Catch::Contains("0.10 and 1.50 %") && Catch::Contains("up to 3.2 s"));
    CHECK_THAT(told(sim::Fidelity::reference), Catch::Contains("0.001 and 0.081") && Catch::Contains("0.00 and 0.23 %") && Catch::Contains("up to 11 s"));
}

TEST_CASE("the simulation panel as it looks", "[.screens]") {
    const OwnSettings settings;
    Shown shown(sample("angle-interlock-b"));
    SimulationPanel& panel = *shown.panel;
    const auto save = [&](const char* name) {
        shown.window.grab().save(screen_file(QStringLiteral("simulation-%1.png").arg(QLatin1String(name))));
    };
    panel.fidelity()->choice()->setCurrentIndex(1);
    save("idle");
    shown.press(panel.run_action());
    REQUIRE(shown.until([&] { return panel.state().progress.step > 60; }));
    save("running");
    REQUIRE(shown.until_inspected());
    QTest::mouseClick(panel.plot(), Qt::LeftButton, {}, QPoint(panel.plot()->width() / 2, 40));
    save("rest");
    panel.findings()->plan()->setExpanded(true);
    panel.message_bar()->tell(MessageBar::Kind::warning, "box:8444: the connection was lost; trying again");
    save("plan");
    panel.tabs()->setCurrentIndex(1);
    save("yarns");
    panel.tabs()->setCurrentIndex(2);
    save("cloth");
    QPalette dark;
    dark.setColor(QPalette::Window, QColor(45, 45, 48));
    dark.setColor(QPalette::Base, QColor(30, 30, 32));
    dark.setColor(QPalette::WindowText, Qt::white);
    dark.setColor(QPalette::Text, Qt::white);
    dark.setColor(QPalette::Button, QColor(60, 60, 64));
    dark.setColor(QPalette::ButtonText, Qt::white);
    dark.setColor(QPalette::ToolTipBase, QColor(60, 60, 64));
    dark.setColor(QPalette::ToolTipText, Qt::white);
    dark.setColor(QPalette::Link, QColor(0x56, 0xb4, 0xe9));
    shown.window.setPalette(dark);
    panel.tabs()->setCurrentIndex(0);
    save("dark");
    ServersDialog dialog({{"box:8444", "/home/dora/token", ""}, {"unix:/run/simd/simd.sock", "", ""}});
    dialog.show();
    REQUIRE(QTest::qWaitForWindowExposed(&dialog));
    dialog.grab().save(screen_file("simulation-servers.png"));
}
