#include <studio/support/viewport_samples.hpp>
#include <studio/viewport/picking.hpp>
#include <studio/viewport/words.hpp>

#include <chrono>
#include <set>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

Ray down_at(double x, double y) {
    return {{x, y, 100}, {0, 0, -1}};
}

}  // namespace

TEST_CASE("a model of planned curves has every yarn, and its pieces stay near the curves") {
    const ClothCurves curves = sample_curves();
    const auto model = TubeModel::planned(sample_design(), curves);
    REQUIRE(model);
    REQUIRE(model->yarns().size() == curves.yarns.size());
    CHECK(model->crossings().size() == curves.crossings.size());
    for (std::size_t y = 0; y < curves.yarns.size(); ++y) {
        CHECK(model->yarns()[y].number == curves.yarns[y].number);
        CHECK(model->yarns()[y].system == curves.yarns[y].system);
        std::vector<Vec3> keys;
        for (const KeyPoint& key : curves.yarns[y].keys) keys.push_back(key.place);
        const Spline spline = interpolate(keys, curves.yarns[y].is_periodic, curves.yarns[y].shift);
        for (double t = 0; t < static_cast<double>(spline.segments()); t += 0.37) {
            double nearest = 1e9;
            for (std::uint32_t k = 0; k < model->levels().front().count; ++k) {
                const TubePiece piece = model->piece(k);
                if (piece.yarn != y) continue;
                nearest =
                    std::min(nearest, (spline.place(t) - nearest_on_axis(piece, spline.place(t))).norm());
            }
            CHECK(nearest < 0.06 * model->yarns()[y].radius_mm);
        }
    }
}

TEST_CASE("coarser levels have fewer pieces that lead through the same yarns") {
    const auto model = model_of(sample_yarns());
    std::size_t before = model->levels().front().count + 1;
    for (const Level& level : model->levels()) {
        CHECK(level.count < before);
        before = level.count;
        std::set<std::uint32_t> yarns;
        std::size_t in_chunks = 0;
        for (const Chunk& chunk : level.chunks) in_chunks += chunk.count;
        CHECK(in_chunks == level.count);
        for (std::uint32_t k = level.first; k < level.first + level.count; ++k)
            yarns.insert(model->pieces()[k].yarn);
        CHECK(yarns.size() == model->yarns().size());
    }
}

TEST_CASE("relaxed yarns are coloured in every way, with a scale where numbers colour them") {
    const auto yarns = sample_yarns();
    for (std::size_t k = 0; k < colourings; ++k) {
        const auto colour = static_cast<ColourBy>(k);
        const auto model = model_of(yarns, colour);
        CHECK(model->is_scalar() == (colour >= ColourBy::strain));
        CHECK(scale_title(colour).isEmpty() != model->is_scalar());
        CHECK_FALSE(colour_name(colour).isEmpty());
        if (!model->is_scalar()) continue;
        double least = 1e9, most = -1e9;
        for (const Knot& knot : model->knots()) {
            least = std::min(least, double{knot.value});
            most = std::max(most, double{knot.value});
        }
        CHECK(most > least);
        CHECK(model->high() == Approx(most));
        CHECK(model->low() <= least + 1e-6);
    }
    const auto by_system = model_of(yarns, ColourBy::system);
    std::set<Colour> warp, weft;
    for (const ModelYarn& yarn : by_system->yarns())
        (yarn.system == System::warp ? warp : weft).insert(yarn.colour);
    CHECK(warp.size() == 1);
    CHECK(weft.size() == 1);
    CHECK(warp != weft);
    // The strain of the straight yarns is known: 0 to 10 %.
    const auto strained = model_of(crossed_yarns(), ColourBy::strain);
    CHECK(strained->low() == Approx(0).margin(1e-9));
    CHECK(strained->high() == Approx(10));
}

TEST_CASE("yarns that say too little are refused") {
    CHECK_FALSE(TubeModel::relaxed(nullptr));
    CHECK_FALSE(TubeModel::relaxed(std::make_shared<const Yarns>()));
    auto broken = std::make_shared<Yarns>(*crossed_yarns());
    broken->yarns[1].strain.pop_back();
    CHECK_FALSE(TubeModel::relaxed(broken));
}

TEST_CASE(
    "a live frame moves the yarns and leaves their pieces; other numbers of points are welcome, other yarns "
    "are not") {
    const auto yarns = sample_yarns();
    const auto model = model_of(yarns, ColourBy::moved);
    const std::size_t pieces = model->pieces().size();
    const Box before = model->box();
    std::vector<std::vector<Vec3>> control;
    for (const SimulatedYarn& yarn : yarns->yarns) {
        control.push_back(yarn.spline.control);
        for (Vec3& place : control.back()) place += Vec3(0, 0, 5);
    }
    REQUIRE(model->update(control));
    CHECK(model->pieces().size() == pieces);
    CHECK(model->box().low.z() == Approx(before.low.z() + 5));
    CHECK(model->box().high.z() == Approx(before.high.z() + 5));
    CHECK(model->high() > 4.5);  // they are 5 mm from where they rested, and so from the plan
    CHECK_FALSE(model->values_are_old());
    for (std::size_t y = 0; y < control.size(); ++y)
        control[y] = resample(yarns->yarns[y].spline, 2 * yarns->yarns[y].spline.control.size() + 3).control;
    REQUIRE(model->update(control));
    CHECK(model->box().high.z() == Approx(before.high.z()).margin(0.05));
    const auto strained = model_of(yarns, ColourBy::strain);
    REQUIRE(strained->update(control));
    CHECK(strained->values_are_old());
    const Box now = model->box();
    control.back().clear();
    CHECK_FALSE(model->update(control));
    control.pop_back();
    CHECK_FALSE(model->update(control));
    CHECK((model->box().low - now.low).norm() == 0);
}

TEST_CASE("what a live frame costs", "[.bench]") {
    auto yarns = std::make_shared<Yarns>();
    for (std::size_t k = 0; k < 100; ++k) {
        SimulatedYarn yarn = straight_yarn(System::warp, k, {0, 0, 0}, {1, 0, 0}, {});
        yarn.spline.control.clear();
        for (int i = 0; i < 100; ++i)
            yarn.spline.control.emplace_back(i * 0.25, double(k), 0.2 * std::sin(i * 0.8));
        yarn.planned = yarn.spline.control;
        yarn.strain.assign(100, 0);
        yarn.contact_N.assign(100, 0);
        yarns->yarns.push_back(yarn);
    }
    const auto model = model_of(yarns);
    std::vector<std::vector<Vec3>> control;
    for (const SimulatedYarn& yarn : yarns->yarns) control.push_back(yarn.spline.control);
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < 20; ++k) REQUIRE(model->update(control));
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / 20;
    WARN("10,000 control points, " << model->knots().size() << " knots: " << ms << " ms a frame");
}

TEST_CASE("a ray finds the yarns at known places, the nearest first") {
    const auto model = model_of(crossed_yarns());
    const auto found = hits(*model, {}, down_at(5, 5));
    REQUIRE(found.size() == 2);
    CHECK(found[0].yarn == 1);
    CHECK(found[0].place.z() == Approx(1.5));
    CHECK(found[1].yarn == 0);
    CHECK(found[1].place.z() == Approx(0.5));
    CHECK(hits(*model, {}, down_at(2, 2)).empty());
    CHECK(hits(*model, {}, down_at(2, 5.45)).size() == 1);
    CHECK(hits(*model, {}, down_at(2, 5.55)).empty());
    // Yarns end flat, at their last point.
    CHECK(hits(*model, {}, down_at(9.95, 5)).size() == 1);
    CHECK(hits(*model, {}, down_at(10.2, 5)).empty());
    CHECK(yarn_words(*model, 1, found[0].place) == "end 12 · beam 1");
    CHECK(yarn_words(*model, 0, found[1].place) == "pick 7");
}

TEST_CASE("what is cut away cannot be picked; what the plane cuts is told") {
    const auto model = model_of(crossed_yarns());
    Shown shown;
    shown.clip = Plane{{0, 0, 1}, 1};  // half of the ends is gone
    auto found = hits(*model, shown, down_at(5, 5));
    REQUIRE(found.size() == 2);
    CHECK(found[0].is_cut);
    CHECK(found[0].place.z() == Approx(1));
    shown.clip->height = 0.45;  // below the ends
    found = hits(*model, shown, down_at(5, 5));
    REQUIRE(found.size() == 1);
    CHECK(found[0].yarn == 0);
    CHECK(found[0].is_cut);
}

TEST_CASE("repeats can be picked, and belong to the same yarns") {
    const auto model = model_of(sample_yarns());
    REQUIRE((model->is_periodic()[0] && model->is_periodic()[1]));
    const Box box = model->box();
    const Vec3 at = box.centre();
    const Shown shown{{2, 3}, {}};
    const auto once = hits(*model, shown, down_at(at.x(), at.y()));
    const auto moved =
        hits(*model, shown, down_at(at.x() + model->size_mm()[0], at.y() + 2 * model->size_mm()[1]));
    REQUIRE_FALSE(once.empty());
    std::set<std::uint32_t> a, b;
    for (const Hit& hit : once) a.insert(hit.yarn);
    for (const Hit& hit : moved) b.insert(hit.yarn);
    CHECK(a == b);
    CHECK(box_of(*model, {2, 3}).size().y() == Approx(box.size().y() + 2 * model->size_mm()[1]));
}

TEST_CASE("two yarns that cross are found by their crossing, whatever the order and the repeat") {
    const auto model = model_of(crossed_yarns());
    const auto crossing = model->crossing_of(1, 0, {5, 5, 1});
    REQUIRE(crossing);
    CHECK((crossing->pick == 6 && crossing->end == 11));
    CHECK(model->crossing_of(0, 2, {0, 0, 0})->end == 12);
    CHECK_FALSE(model->crossing_of(1, 2, {5, 5, 1}));
    CHECK((crossing->place - Vec3(5, 5, 0.5)).norm() < 1e-6);
    // Only near its middle is a click one on the crossing.
    CHECK(crossing_at(*model, hits(*model, {}, down_at(5, 5.1)), down_at(5, 5.1)));
    CHECK_FALSE(crossing_at(*model, hits(*model, {}, down_at(5.45, 5)), down_at(5.45, 5)));
    CHECK_FALSE(crossing_at(*model, hits(*model, {}, down_at(8, 5)), down_at(8, 5)));
    // In the sample each crossing is the nearest to its own place, also a repeat further.
    const auto cloth = model_of(sample_yarns());
    REQUIRE_FALSE(cloth->crossings().empty());
    for (const ModelCrossing& of : cloth->crossings()) {
        const Vec3 repeat = of.place + Vec3(cloth->size_mm()[0], -cloth->size_mm()[1], 0);
        const auto found = cloth->crossing_of(of.warp, of.weft, repeat);
        REQUIRE(found);
        CHECK((found->pick == of.pick && found->end == of.end));
    }
}
