// How the cloth's yarns are set up, by mouse and keys.

#include <weave/samples/samples.hpp>

#include <studio/panels/yarn_table.hpp>
#include <studio/panels/yarns_panel.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::studio;

namespace {

/// The panel beside a document, as wide as a narrow dock.
struct Narrow {
    explicit Narrow(Design design) : document(std::move(design), {}, true, folder.path) {
        panel.show_document(&document);
        panel.resize(400, 900);
        panel.show();
        REQUIRE(QTest::qWaitForWindowExposed(&panel));
    }
    YarnTable& table(const char* name) { return *panel.findChild<YarnTable*>(name); }

    weave::testing::TemporaryFolder folder;
    Document document;
    YarnsPanel panel;
};

Design with_odd_figures() {
    Design design = find_sample("plain")->make();
    design.warp.density_ends_per_cm = 37.7358;
    design.weft.density_picks_per_cm = 18.4321;
    design.warp.yarns.front().radius_mm = 0.123456789012;
    return design;
}

}  // namespace

TEST_CASE("figures that nobody edits stay as they are when a yarn is renamed") {
    Narrow shown(with_odd_figures());
    shown.table("warp-yarns").item(0, 0)->setText("another name");
    shown.table("weft-yarns").item(0, 0)->setText("a third");
    const Design& design = shown.document.design();
    CHECK(design.warp.yarns.front().name == "another name");
    CHECK(design.weft.yarns.front().name == "a third");
    CHECK(design.warp.density_ends_per_cm == 37.7358);
    CHECK(design.weft.density_picks_per_cm == 18.4321);
    CHECK(design.warp.yarns.front().radius_mm == 0.123456789012);
    shown.panel.findChild<QDoubleSpinBox*>("warp-density")->setValue(20.5);
    CHECK(design.warp.density_ends_per_cm == 20.5);
    shown.table("warp-yarns").item(0, 2)->setText("0.2");
    CHECK(design.warp.yarns.front().radius_mm == 0.2);
}

TEST_CASE("a double-click on a yarn's colour asks for it once, and nothing has to be scrolled sideways") {
    Narrow shown(with_odd_figures());
    YarnTable& table = shown.table("warp-yarns");
    CHECK(table.item(0, 1)->text().isEmpty());
    int asked = 0;
    QTimer watch;
    QObject::connect(&watch, &QTimer::timeout, [&] {
        auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
        if (dialog != nullptr) ++asked, dialog->reject();
    });
    watch.start(10);
    const QPoint patch = table.visualItemRect(table.item(0, 1)).center();
    QTest::mouseClick(table.viewport(), Qt::LeftButton, {}, patch);
    QTest::mouseDClick(table.viewport(), Qt::LeftButton, {}, patch);
    QCoreApplication::processEvents();
    CHECK(asked == 1);
    CHECK(shown.document.design() == with_odd_figures());
    INFO(table.columnWidth(0) << " of " << table.horizontalHeader()->length() << ", a line " << table.fontMetrics().height());
    CHECK(QTest::qWaitFor([&] { return table.horizontalHeader()->length() <= table.viewport()->width(); }));
    CHECK(shown.panel.findChild<QScrollArea*>()->horizontalScrollBar()->maximum() == 0);
    shown.panel.resize(290, 900);
    REQUIRE(QTest::qWaitFor([&] { return table.viewport()->width() < 280; }));
    CHECK(table.visualItemRect(table.item(0, 1)).right() < table.viewport()->width());  // the colour stays in sight
    CHECK(table.visualItemRect(table.item(0, 1)).bottom() < table.viewport()->height());
    const auto* density = shown.panel.findChild<QDoubleSpinBox*>("weft-density");
    CHECK(QTest::qWaitFor([&] { return density->height() >= density->minimumSizeHint().height(); }));
    CHECK(shown.panel.width() >= shown.panel.minimumSizeHint().width());
    const int gap = shown.panel.findChild<QWidget*>("notes")->geometry().top() - shown.panel.findChild<QWidget*>("title")->geometry().bottom();
    CHECK(gap < 2 * shown.panel.fontMetrics().height());
}
