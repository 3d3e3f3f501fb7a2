// Where residuals lie on their plot.

#include <QtTest>

#include <catch2/catch.hpp>

#include <cmath>
#include <studio/panels/simulation_residual_plot.hpp>

using namespace weave::studio;

TEST_CASE("the plot of residuals has whole decades, and steps evenly") {
    const ResidualScale scale(QRectF(100, 10, 400, 300), 200, 2e-3, 0.7);
    CHECK(scale.lowest_decade() == -3);
    CHECK(scale.highest_decade() == 0);
    CHECK(scale.x_of(0) == 100);
    CHECK(scale.x_of(50) == 200);
    CHECK(scale.x_of(200) == 500);
    CHECK(scale.y_of(1) == Approx(10));
    CHECK(scale.y_of(0.1) == Approx(110));
    CHECK(scale.y_of(1e-3) == Approx(310));
    CHECK(scale.y_of(1e-9) == Approx(310));  // at its rim
    CHECK(scale.y_of(50) == Approx(10));
    CHECK(scale.step_at(300) == Approx(100));
    CHECK(scale.step_at(-5) == 0);
    CHECK(scale.step_at(900) == 200);
    CHECK(scale.y_of(2e-3) == Approx(310 - 100 * std::log10(2)));
    CHECK(scale.decades(10) == std::vector{-3, -2, -1, 0});
    CHECK(scale.decades(2) == std::vector{-3, -1});
    CHECK(scale.steps(5) == std::vector<std::uint64_t>{0, 50, 100, 150, 200});
    CHECK(scale.steps(2) == std::vector<std::uint64_t>{0, 100, 200});
}

TEST_CASE("a decade that residuals fill exactly is not doubled, and one value has room above") {
    const ResidualScale exact(QRectF(0, 0, 10, 10), 1, 1e-3, 1);
    CHECK(exact.lowest_decade() == -3);
    CHECK(exact.highest_decade() == 0);
    const ResidualScale single(QRectF(0, 0, 10, 10), 0, 0.01, 0.01);
    CHECK(single.lowest_decade() == -2);
    CHECK(single.highest_decade() == -1);
    CHECK(std::isfinite(single.x_of(0)));
    const ResidualScale wild(QRectF(0, 0, 10, 10), 1, 0, INFINITY);
    CHECK(wild.highest_decade() - wild.lowest_decade() == 30);
}

TEST_CASE("a click on the plot shows the nearest step's value, and arrow keys go on from there") {
    ResidualPlot plot;
    plot.resize(400, 200);
    plot.set_goal(1e-3);
    std::vector<ResidualPoint> points;
    for (std::uint64_t step = 1; step <= 100; ++step)
        points.push_back({step, std::pow(10, -0.03 * static_cast<double>(step))});
    plot.add(points);
    plot.show();
    REQUIRE(QTest::qWaitForWindowExposed(&plot));
    CHECK_FALSE(plot.marked());
    const ResidualScale scale = plot.scale();
    QTest::mouseClick(&plot, Qt::LeftButton, {}, QPointF(scale.x_of(40.3), 50).toPoint());
    REQUIRE(plot.marked());
    CHECK(plot.marked()->step == 40);
    QTest::keyClick(&plot, Qt::Key_Right);
    CHECK(plot.marked()->step == 41);
    QTest::keyClick(&plot, Qt::Key_Left);
    QTest::keyClick(&plot, Qt::Key_Left);
    CHECK(plot.marked()->step == 39);
    CHECK(plot.accessibleDescription().contains("39"));
    QTest::keyClick(&plot, Qt::Key_Escape);
    CHECK_FALSE(plot.marked());
    plot.add({{50, 0.5}});  // a server went on from there
    CHECK(plot.points().size() == 50);
    CHECK(plot.points().back().residual == 0.5);
}

TEST_CASE("the plot keeps no more points than can be seen") {
    ResidualPlot plot;
    for (std::uint64_t step = 1; step <= 40'000; ++step) plot.add({{step, 0.1}});
    CHECK(plot.points().size() <= 8192);
    CHECK(plot.points().front().step == 1);
    CHECK(plot.points().back().step == 40'000);
}

TEST_CASE("what the dashed line means stands where no curve comes") {
    ResidualPlot plot;
    plot.resize(260, 180);
    plot.set_goal(1e-2);
    plot.add({{1, 1}, {100, 1e-3}});
    plot.show();
    REQUIRE(QTest::qWaitForWindowExposed(&plot));
    const QImage seen = plot.grab().toImage();
    const ResidualScale scale = plot.scale();
    const auto is_goal = [&](int x, int y) {
        const QColor colour = seen.pixelColor(x, y);
        return colour.red() > 150 && colour.blue() < 120;
    };
    const int line = static_cast<int>(scale.y_of(1e-2));
    int on_area = 0, below = 0;
    for (int y = 0; y < seen.height(); ++y) {
        for (int x = static_cast<int>(scale.area().left()); x < seen.width(); ++x) {
            if (!is_goal(x, y) || std::abs(y - line) < 4) continue;
            ++(y < scale.area().bottom() ? on_area : below);
        }
    }
    CHECK(on_area == 0);
    CHECK(below > 0);
}
