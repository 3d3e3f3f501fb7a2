// The simulation beside a document in the window: what is simulated is the design that is shown, and no other.

#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>

#include <set>
#include <studio/commands/tile_block.hpp>
#include <studio/editors/card_editor.hpp>
#include <studio/panels/findings_panel.hpp>
#include <studio/panels/message_bar.hpp>
#include <studio/panels/simulation_fidelity_group.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/panels/simulation_region_group.hpp>
#include <studio/panels/submit_panel.hpp>
#include <studio/support/follow_run.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/main_window.hpp>
#include <studio/window/simulation_desk.hpp>

#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

using Places = std::set<std::pair<std::size_t, std::size_t>>;  // picks and ends from 1

/// The cloth of a design, now a block `of`, so many times.
Design repeated(Design design, std::size_t x, std::size_t y) {
    REQUIRE(apply_edit(design, RenameBlock{design.root, "of"}));
    REQUIRE(apply_edit(design, PutBlock{"cloth", std::make_shared<const Node>(Node{TileOperation{"of", x, y, 1}, {}})}));
    REQUIRE(apply_edit(design, SetRoot{"cloth"}));
    return design;
}

/// A window with a design that relaxes as a draft.
class Loom {
  public:
    explicit Loom(const char* name) {
        window.resize(1500, 1000);
        window.show();
        REQUIRE(QTest::qWaitForWindowExposed(&window));
        QApplication::setActiveWindow(&window);
        open(name);
    }
    void open(const char* name) { open(sample(name)); }
    void open(Design design) {
        window.show_design(std::move(design), {}, true);
        simulation().fidelity()->choice()->setCurrentIndex(0);
        settle();
    }
    void settle() {
        REQUIRE(until([&] { return document().shown_is_current() && document().whole().revision == document().revision(); }));
        QCoreApplication::processEvents();
    }
    [[nodiscard]] bool until(const std::function<bool()>& enough) {
        const bool came = QTest::qWaitFor(enough, patience_ms);
        if (!came) UNSCOPED_INFO(simulation().sentence()->text().toStdString() << "; " << simulation().message_bar()->words().toStdString());
        return came;
    }
    void relax() {
        QAction* again = simulation().again_action();
        (again->isEnabled() ? again : simulation().run_action())->trigger();
        REQUIRE(until([&] { return simulation().state().inspection != nullptr; }));
    }
    /// On which side the simulated cloth has a crossing; nothing while it moves.
    [[nodiscard]] bool follows(std::size_t flips) {
        const auto& yarns = simulation().state().yarns;
        return simulation().state().phase == RunPhase::at_rest && yarns && yarns->report.contains("flips") && yarns->report.at("flips").size() == flips;
    }
    /// The crossings that the run turned and did not turn back.
    [[nodiscard]] Places turned() {
        Places places;
        for (const Json& flip : simulation().state().yarns->report.at("flips")) {
            if (!flip.at("done").get<bool>()) continue;
            const std::pair place{flip.at("pick").get<std::size_t>(), flip.at("end").get<std::size_t>()};
            if (!places.insert(place).second) places.erase(place);
        }
        return places;
    }
    template <class Widget>
    Widget& find(const QString& name = {}) {
        auto* found = window.findChild<Widget*>(name);
        REQUIRE(found != nullptr);
        return *found;
    }
    Document& document() { return *window.document(); }
    SimulationPanel& simulation() { return find<SimulationPanel>(); }
    QString evidence() { return find<QLabel>("evidence").text(); }
    /// Flips that the cloth's own block has.
    std::vector<Flip> flips() { return document().design().blocks.at(document().design().root)->flips; }
    Flip flip_at(std::size_t pick, std::size_t end) { return {pick, end, !document().whole().block->weft_over(pick, end)}; }
    EditStep flipping(const Flip& flip) { return {"flip", {PutFlip{document().design().root, flip}}}; }

    MainWindow window;
};

}  // namespace

TEST_CASE("a run ends with the document that it is of: nothing of it reaches the next") {
    Loom loom("plain");
    loom.relax();
    CHECK(loom.evidence().contains("at rest"));
    REQUIRE(loom.find<SimulationDesk>().flip({0, 0}));  // it is under way while another design is opened
    loom.open("twill-2-2");
    CHECK(loom.simulation().state().phase == RunPhase::idle);
    CHECK_FALSE(loom.simulation().stop_action()->isEnabled());
    CHECK_FALSE(loom.simulation().save_action()->isEnabled());
    CHECK(loom.find<ViewerPanel>().mode() == ViewerPanel::Mode::planned);
    CHECK(loom.evidence().contains("none yet"));
    loom.relax();
    CHECK(loom.flips().empty());
    CHECK(loom.document().undo_stack().count() == 0);
    CHECK(loom.evidence().contains("at rest"));
    loom.window.close();
    CHECK(loom.simulation().state().phase == RunPhase::idle);
}

TEST_CASE("a flip made on the card is led into the simulated cloth, and the other way when it is undone") {
    Loom loom("plain");
    loom.relax();
    REQUIRE(loom.document().perform(loom.flipping(loom.flip_at(1, 1))));
    CHECK_FALSE(loom.simulation().is_out_of_date());
    REQUIRE(loom.until([&] { return loom.follows(1); }));
    CHECK(loom.simulation().state().yarns->report.at("flips").back().at("done") == true);
    CHECK(loom.document().undo_stack().count() == 1);  // it is not performed once more
    CHECK(loom.flips().size() == 1);
    loom.document().undo();
    loom.settle();
    CHECK_FALSE(loom.simulation().is_out_of_date());
    REQUIRE(loom.until([&] { return loom.follows(2); }));
    CHECK(loom.simulation().state().yarns->report.at("flips").back().at("done") == true);
    CHECK(loom.flips().empty());
    CHECK(loom.document().undo_stack().index() == 0);
    CHECK_FALSE(loom.simulation().is_out_of_date());
}

TEST_CASE("a flip in a block that is repeated is led at each of its places in the simulated cloth, and back when it is undone") {
    Loom loom("plain");
    loom.open(repeated(sample("twill-2-2"), 2, 2));
    loom.relax();
    REQUIRE(loom.document().perform({"flip", {PutFlip{"of", loom.flip_at(1, 1)}}}));
    REQUIRE(loom.until([&] { return loom.follows(4); }));
    CHECK(loom.turned() == Places{{2, 2}, {2, 6}, {6, 2}, {6, 6}});
    CHECK_FALSE(loom.simulation().is_out_of_date());
    CHECK(loom.flips().empty());
    CHECK(loom.document().undo_stack().count() == 1);
    loom.document().undo();
    REQUIRE(loom.until([&] { return loom.follows(8); }));
    CHECK(loom.turned().empty());
    CHECK_FALSE(loom.simulation().is_out_of_date());
}

TEST_CASE("a block that is flipped at more places than are led leaves the run out of date, until that is undone") {
    Loom loom("plain");
    loom.open(repeated(sample("plain"), 9, 9));
    loom.simulation().step_action()->trigger();
    REQUIRE(loom.until([&] { return loom.simulation().state().phase == RunPhase::paused; }));
    REQUIRE(loom.document().perform({"flip", {PutFlip{"of", loom.flip_at(1, 1)}}}));
    REQUIRE(loom.until([&] { return loom.simulation().is_out_of_date(); }));
    loom.document().undo();
    REQUIRE(loom.until([&] { return !loom.simulation().is_out_of_date(); }));
    REQUIRE(loom.document().perform({"another weave", {PutBlock{"of", std::make_shared<const Node>(Node{PresetLeaf{{"basket", {}}}, {}})}}}));
    CHECK(loom.simulation().is_out_of_date());  // no flip: that is known at once
}

TEST_CASE("a flip made in space is one edit, and its undo turns the cloth back") {
    Loom loom("plain");
    loom.relax();
    REQUIRE(loom.find<SimulationDesk>().flip({1, 1}));
    REQUIRE(loom.until([&] { return loom.follows(1); }));
    REQUIRE(loom.until([&] { return loom.document().undo_stack().count() == 1; }));
    loom.document().undo();
    REQUIRE(loom.until([&] { return loom.follows(2); }));
    CHECK(loom.flips().empty());
    CHECK_FALSE(loom.simulation().is_out_of_date());
}

TEST_CASE("a flip that the run does not take leaves it out of date, until the flip is undone") {
    Loom loom("plain");
    loom.open(repeated(sample("plain"), 8, 8));
    RegionGroup& region = *loom.simulation().region();
    region.part()->setChecked(true);
    region.last_row()->setValue(6);
    region.last_column()->setValue(6);
    loom.relax();
    std::vector<bool> told;
    QObject::connect(&loom.simulation(), &SimulationPanel::dated_changed, &loom.window, [&](bool is_dated) { told.push_back(is_dated); });
    REQUIRE(loom.document().perform(loom.flipping(loom.flip_at(12, 12))));  // beside the part
    REQUIRE(loom.until([&] { return loom.simulation().is_out_of_date(); }));
    CHECK(loom.simulation().message_bar()->words().contains("does not follow at pick 13, end 13"));
    CHECK(loom.simulation().sentence()->text().startsWith("The design before the change: "));
    loom.document().undo();
    REQUIRE(loom.until([&] { return !loom.simulation().is_out_of_date(); }));
    CHECK(told == std::vector{true, false});
}

TEST_CASE("a flip that has no place in the cloth changes nothing, and the run goes on as of this design") {
    Loom loom("plain");
    loom.relax();
    REQUIRE(loom.document().perform(loom.flipping({500, 500, true})));
    loom.settle();
    QTest::qWait(50);
    CHECK_FALSE(loom.simulation().is_out_of_date());
    CHECK(loom.simulation().message_bar()->words().isEmpty());
}

TEST_CASE("evidence is of what was simulated, where that ran, and no file") {
    const weave::testing::TemporaryFolder folder;
    const QString file = QString::fromStdString((folder.path / "cloth.yarns").string());
    Loom loom("plain");
    auto& simulation = loom.simulation();
    loom.relax();
    CHECK(loom.evidence().contains("relaxed on This computer at draft, at rest"));
    CHECK_FALSE(loom.evidence().contains("has changed since"));
    simulation.save_to(file);
    REQUIRE(loom.until([&] { return simulation.message_bar()->words().contains("Saved"); }));
    // Yarns that come to rest after the design has changed are of the design before.
    REQUIRE(loom.document().perform({"title", {SetRoot{loom.document().design().root}}}));
    simulation.again_action()->trigger();
    Design other = loom.document().design();
    Scene scene = other.scene;
    scene.gravity = !scene.gravity;
    REQUIRE(loom.document().perform({"gravity", {SetScene{scene}}}));
    REQUIRE(loom.until([&] { return simulation.state().inspection != nullptr; }));
    CHECK(loom.evidence().contains("has changed since"));
    // Others' yarns are looked at, and are no evidence.
    loom.open("twill-2-2");
    simulation.open(file);
    REQUIRE(loom.until([&] { return simulation.message_bar()->words().contains("from a file"); }));
    CHECK(loom.evidence().contains("none yet"));
}

TEST_CASE("rules on the take-up are judged once the cloth is at rest, and not after an edit") {
    Loom loom("plain");
    auto& findings = loom.find<FindingsPanel>();
    const auto unjudged = [&] { return findings.report() ? findings.report()->not_evaluated.size() : 1000; };
    REQUIRE(loom.until([&] { return findings.report().has_value(); }));
    const std::size_t before = unjudged();
    loom.relax();
    REQUIRE(loom.until([&] { return unjudged() < before; }));
    Scene scene = loom.document().design().scene;
    scene.gravity = !scene.gravity;
    REQUIRE(loom.document().perform({"gravity", {SetScene{scene}}}));
    REQUIRE(loom.until([&] { return unjudged() == before; }));
}

TEST_CASE("rules on the take-up are judged again where undo has brought back the cloth that rests") {
    Loom loom("plain");
    const auto unjudged = [&] {
        const auto& report = loom.find<FindingsPanel>().report();
        return report ? report->not_evaluated.size() : 1000;
    };
    REQUIRE(loom.until([&] { return unjudged() < 1000; }));
    const std::size_t before = unjudged();
    loom.relax();
    REQUIRE(loom.until([&] { return unjudged() < before; }));
    const std::size_t judged = unjudged();

    SECTION("a flip") {
        REQUIRE(loom.document().perform(loom.flipping(loom.flip_at(1, 1))));
        REQUIRE(loom.until([&] { return loom.follows(1) && unjudged() == judged; }));
        loom.document().undo();
        REQUIRE(loom.until([&] { return loom.follows(2); }));
        CHECK(loom.until([&] { return unjudged() == judged; }));
        CHECK(loom.evidence().contains("at rest"));
        CHECK_FALSE(loom.evidence().contains("has changed since"));
        loom.document().redo();
        REQUIRE(loom.until([&] { return loom.follows(3); }));
        CHECK(loom.until([&] { return unjudged() == judged; }));
    }
    SECTION("another scene, which the run does not follow") {
        Scene scene = loom.document().design().scene;
        scene.gravity = !scene.gravity;
        REQUIRE(loom.document().perform({"gravity", {SetScene{scene}}}));
        REQUIRE(loom.until([&] { return unjudged() == before; }));
        loom.document().undo();
        CHECK(loom.until([&] { return unjudged() == judged; }));
    }
}

TEST_CASE("yarns at rest bear the name of the design that they were led to, whatever flips led there") {
    Loom loom("plain");
    loom.open(repeated(sample("twill-2-2"), 2, 2));
    loom.relax();
    const auto name = [&] { return loom.simulation().state().yarns->design_sha256; };
    REQUIRE(loom.document().perform({"flip", {PutFlip{"of", loom.flip_at(1, 1)}}}));
    REQUIRE(loom.until([&] { return loom.follows(4); }));  // the run made four, the design has one
    CHECK(name() == design_sha256(loom.document().design()));
    loom.document().undo();
    REQUIRE(loom.until([&] { return loom.follows(8); }));
    CHECK(name() == design_sha256(loom.document().design()));
}

TEST_CASE("findings are of the document that is shown, and none where there is no cloth") {
    Loom loom("plain");
    auto& findings = loom.find<FindingsPanel>();
    REQUIRE(loom.until([&] { return findings.report().has_value(); }));
    loom.window.show_design(sample("twill-2-2"), {}, true);
    CHECK_FALSE(findings.report());
    CHECK(loom.find<QLabel>("findings_summary").text().contains("not looked for yet"));
    CHECK(loom.find<QDockWidget>("findings-dock").windowTitle() == "Findings");
    REQUIRE(loom.until([&] { return findings.report().has_value(); }));
}

TEST_CASE("findings that are still looked for when a document goes do not come afterwards") {
    const weave::testing::TemporaryFolder folder;
    Document document(sample("plain"), {}, true, folder.path);
    FindingsPanel panel;
    panel.show_document(&document);
    bool is_left = false;
    QObject::connect(panel.findChild<QTimer*>({}, Qt::FindDirectChildrenOnly), &QTimer::timeout, &panel, [&] {  // right after the look began
        if (!document.whole().block) return;
        panel.show_document(nullptr);
        is_left = true;
    });
    REQUIRE(QTest::qWaitFor([&] { return is_left; }, patience_ms));
    QThreadPool::globalInstance()->waitForDone();
    QCoreApplication::processEvents();
    CHECK_FALSE(panel.report());
}

TEST_CASE("the loom stays when another profile is asked for and not chosen") {
    Loom loom("plain");
    auto& looms = loom.find<QComboBox>("loom");
    REQUIRE(looms.count() > 3);
    looms.setCurrentIndex(1);
    Q_EMIT looms.activated(1);
    looms.setCurrentIndex(looms.count() - 1);
    QTimer person;
    QObject::connect(&person, &QTimer::timeout, [] {
        if (auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget())) dialog->reject();
    });
    person.start(10);
    Q_EMIT looms.activated(looms.count() - 1);
    CHECK(looms.currentIndex() == 1);
    REQUIRE(loom.find<FindingsPanel>().profile() != nullptr);
    CHECK(QString::fromStdString(loom.find<FindingsPanel>().profile()->name) == looms.itemText(1));
}

TEST_CASE("the part that may be simulated follows the cloth, in picks and ends") {
    Loom loom("satin-e");
    RegionGroup& region = *loom.simulation().region();
    loom.open("pocket");
    const BlockPtr cloth = loom.document().whole().block;
    REQUIRE(loom.until([&] { return region.last_row()->maximum() == static_cast<int>(cloth->rows()); }));
    CHECK(region.last_row()->value() == std::min<int>(20, static_cast<int>(cloth->rows())));
    const std::size_t picks = cloth->grid().first_pick(static_cast<std::size_t>(region.last_row()->value()));
    const auto tells = [&](const QString& words) {
        const auto labels = region.findChildren<QLabel*>();
        return std::any_of(labels.begin(), labels.end(), [&](const QLabel* label) { return label->text() == words; });
    };
    CHECK(tells(QString("all of it: picks 1 to %1, ends 1 to %2").arg(cloth->picks()).arg(cloth->ends())));
    region.findChildren<QRadioButton*>()[1]->click();
    REQUIRE(region.region());
    const std::size_t ends = cloth->grid().first_end(static_cast<std::size_t>(region.last_column()->value()));
    CHECK(tells(QString("picks 1 to %1, ends 1 to %2").arg(picks).arg(ends)));
}

TEST_CASE("over the relaxed cloth stands that the design has changed since, until it is as it was") {
    Loom loom("plain");
    loom.relax();
    auto& viewer = loom.find<ViewerPanel>();
    REQUIRE(viewer.mode() == ViewerPanel::Mode::relaxed);
    CHECK(viewer.viewport()->caption().isEmpty());
    WarpPlan warp = loom.document().design().warp;
    warp.density_ends_per_cm *= 1.5;
    REQUIRE(loom.document().perform({"denser", {SetWarp{warp}}}));
    CHECK(viewer.viewport()->caption().contains("Before the last change"));
    viewer.set_mode(ViewerPanel::Mode::planned);
    CHECK_FALSE(viewer.viewport()->caption().contains("Before the last change"));
    viewer.set_mode(ViewerPanel::Mode::relaxed);
    loom.document().undo();
    CHECK(viewer.viewport()->caption().isEmpty());
}

TEST_CASE("nothing holds the relaxed yarns once undo has made the cloth another") {
    Loom loom("plain");
    std::string name;
    auto step = tile_block(loom.document().design(), loom.document().design().root, 2, 3, 1, name);
    REQUIRE(step);
    step->edits.push_back(SetRoot{name});
    REQUIRE(loom.document().perform(*step));
    loom.settle();
    loom.relax();
    REQUIRE(loom.find<ViewerPanel>().mode() == ViewerPanel::Mode::relaxed);
    const std::weak_ptr<const Yarns> yarns = loom.simulation().state().yarns;
    const std::weak_ptr<const Inspection> inspection = loom.simulation().state().inspection;
    REQUIRE_FALSE(yarns.expired());
    loom.document().undo();
    CHECK(loom.until([&] { return yarns.expired() && inspection.expired(); }));
    CHECK(loom.simulation().state().phase == RunPhase::idle);
    CHECK_FALSE(loom.simulation().stop_action()->isEnabled());
    CHECK_FALSE(loom.simulation().save_action()->isEnabled());
    CHECK(loom.find<ViewerPanel>().mode() == ViewerPanel::Mode::planned);
    CHECK(loom.find<SimulationDesk>().yarns() == nullptr);
}

TEST_CASE("cloth that was relaxed at another size makes way for its plan, and Run is offered") {
    Loom loom("plain");
    loom.relax();
    auto& viewer = loom.find<ViewerPanel>();
    auto& messages = loom.find<MessageBar>("messages");
    REQUIRE(viewer.mode() == ViewerPanel::Mode::relaxed);
    REQUIRE(loom.document().perform(loom.flipping(loom.flip_at(1, 1))));
    loom.settle();
    CHECK(viewer.mode() == ViewerPanel::Mode::relaxed);  // a flip is led into it
    std::string name;
    auto step = tile_block(loom.document().design(), loom.document().design().root, 2, 3, 1, name);
    REQUIRE(step);
    step->edits.push_back(SetRoot{name});
    REQUIRE(loom.document().perform(*step));
    REQUIRE(loom.until([&] { return viewer.mode() == ViewerPanel::Mode::planned; }));
    CHECK(messages.words().contains("another size"));
    auto* run = messages.findChild<QToolButton*>("offer");
    REQUIRE(run->isVisible());
    QTest::mouseClick(run, Qt::LeftButton);
    CHECK(messages.words().isEmpty());
    REQUIRE(loom.until([&] { return loom.simulation().state().phase == RunPhase::at_rest && loom.simulation().state().yarns; }));
    CHECK(viewer.mode() == ViewerPanel::Mode::relaxed);
    CHECK(loom.simulation().state().yarns->yarns.size() == loom.document().whole().block->picks() + loom.document().whole().block->ends());
}
