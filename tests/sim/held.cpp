// What is held as planned says nothing of a rest, and is left out of what is measured.

#include <weave/sim/result.hpp>

#include <catch2/catch.hpp>

#include "scenes.hpp"

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

SimYarn along_x(double z_mm, std::vector<std::uint8_t> frozen) {
    SimYarn yarn;
    yarn.radius_mm = 0.1;
    yarn.stretch_N = 40;
    yarn.bending_N_mm2 = 0.02;
    yarn.contact_N_mm2 = 3;
    yarn.rest_mm = 2;
    for (std::size_t i = 0; i < 9; ++i) yarn.control.emplace_back(0.25 * static_cast<double>(i), 0, z_mm);
    yarn.frozen = std::move(frozen);
    return yarn;
}

const std::vector<std::uint8_t> none(9, 0), all(9, 1);

double overlap_of(std::vector<std::uint8_t> lower, std::vector<std::uint8_t> upper) {
    SimScene scene;
    scene.yarns = {along_x(0, std::move(lower)), along_x(0.1, std::move(upper))};
    Bench<> bench(scene);
    bench.evaluate();
    const Contacts contacts = contacts_of(bench.energy, bench.state);
    CHECK(contacts.seen > 0);
    return contacts.overlap;
}

}  // namespace

TEST_CASE("a segment is held where one of the four points that draw it is") {
    SimYarn yarn = along_x(0, {});
    for (std::size_t begin = 0; begin < 8; ++begin) CHECK_FALSE(is_held_at(yarn, begin));
    yarn.frozen = {0, 0, 0, 0, 1, 0, 0, 0, 0};
    for (std::size_t begin = 0; begin < 8; ++begin) {
        INFO(begin);
        CHECK(is_held_at(yarn, begin) == (begin >= 2 && begin <= 5));
    }
    yarn.frozen = {1, 0, 0, 0, 0, 0, 0, 0, 0};
    CHECK((is_held_at(yarn, 0) && is_held_at(yarn, 1) && !is_held_at(yarn, 2) && !is_held_at(yarn, 7)));
    yarn.is_periodic = true;  // its segments go on round the seam
    CHECK((is_held_at(yarn, 7) && is_held_at(yarn, 8) && is_held_at(yarn, 0) && is_held_at(yarn, 1) && !is_held_at(yarn, 2) && !is_held_at(yarn, 6)));
}

TEST_CASE("yarns that are both held where they overlap are not told as overlapping") {
    CHECK(overlap_of(none, none) == Approx(0.5).epsilon(1e-6));
    CHECK(overlap_of(all, none) == Approx(0.5).epsilon(1e-6));
    CHECK(overlap_of(all, all) == 0);
}
