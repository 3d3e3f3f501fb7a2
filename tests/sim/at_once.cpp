// Many cloths on a device that stands for any: in groups that fit, and as they were where it fails.

#include "scenes.hpp"

#include <weave/sim/backend.hpp>
#include <weave/sim/device/relax_device.hpp>

#include <catch2/catch.hpp>

#include <memory>
#include <new>
#include <stdexcept>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// Moves every state by one, and counts; at its `fails`-th cloth it fails as `how` says.
class CountingRelaxer : public DeviceRelaxer {
  public:
    enum class How : std::uint8_t { never, memory, length, device };
    std::vector<std::size_t> groups;
    std::size_t fails = 0, seen = 0;
    How how = How::never;

    RelaxResult relax(Energy<double>&, std::vector<double>& state, const RelaxOptions&) override {
        for (double& number : state) number += 1;
        if (how != How::never && seen == fails) fail();
        RelaxResult result;
        result.iterations = ++seen;
        return result;
    }
    std::vector<RelaxResult> relax_each(std::span<const ClothToRelax> cloths) override {
        groups.push_back(cloths.size());
        std::vector<RelaxResult> results;
        for (const ClothToRelax& cloth : cloths) results.push_back(relax(*cloth.energy, *cloth.state, cloth.options));
        return results;
    }

  private:
    void fail() const {
        if (how == How::memory) throw std::bad_alloc();
        if (how == How::length) throw std::length_error("too long");
        throw DeviceError("a call", 1, "broken");
    }
};

/// Cloths of the same kind, each with a state of its own.
struct Cloths {
    std::vector<std::unique_ptr<Bench<double>>> benches;
    std::vector<ClothToRelax> all;

    explicit Cloths(std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) {
            benches.push_back(std::make_unique<Bench<double>>(plain_weave({})));
            all.push_back({&benches.back()->energy, &benches.back()->state, {}});
        }
    }
    [[nodiscard]] std::size_t bytes() const { return device_bytes(benches.front()->fabric); }
};

}  // namespace

TEST_CASE("cloths relaxed at once go to a device in groups that its memory is expected to hold") {
    Cloths cloths(7);
    CountingRelaxer relaxer;
    const std::vector<RelaxResult> results = relax_at_once(relaxer, 4 * cloths.bytes(), cloths.all);
    CHECK(relaxer.groups == std::vector<std::size_t>{3, 3, 1});  // of four fifths of it
    REQUIRE(results.size() == 7);
    for (std::size_t k = 0; k < 7; ++k) {
        CHECK(results[k].iterations == k + 1);
        CHECK(cloths.benches[k]->state[0] == Bench<double>(plain_weave({})).state[0] + 1);
    }
    CountingRelaxer one_by_one;
    CHECK(relax_at_once(one_by_one, 1, cloths.all).size() == 7);
    CHECK(one_by_one.groups == std::vector<std::size_t>(7, 1));
    CHECK(relax_at_once(one_by_one, 1, {}).empty());
}

TEST_CASE("where a device fails at one of many cloths all are as they were") {
    using How = CountingRelaxer::How;
    for (const How how : {How::memory, How::length, How::device}) {
        Cloths cloths(5);
        CountingRelaxer relaxer;
        relaxer.how = how;
        relaxer.fails = 4;
        CHECK(relax_at_once(relaxer, 3 * cloths.bytes(), cloths.all).empty());
        CHECK(relaxer.groups.size() == 3);
        for (const auto& bench : cloths.benches) CHECK(bench->state == Bench<double>(plain_weave({})).state);
    }
}

TEST_CASE("where the processor is asked for no device is looked at") {
    Cloths cloths(2);
    CHECK_FALSE(may_use_device(Backend::cpu));
    CHECK(relax_at_once(Backend::cpu, cloths.all).empty());
}
