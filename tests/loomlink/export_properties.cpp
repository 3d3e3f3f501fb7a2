// Random cloths on random looms: a decoder that shares nothing with the writers reads what was meant.

#include "../support/random.hpp"
#include "export_case.hpp"
#include "export_decoder.hpp"

#include <loomlink/export/controller_files.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::testing;

namespace {

struct Drawn {
    LoomProfile profile;
    Design design;
    FeederMap map;
};

/// Hands out hooks in random order, each once.
class Pool {
  public:
    Pool(Random& random, std::size_t hooks) {
        for (std::size_t k = 0; k < hooks; ++k) m_left.push_back(k);
        random.shuffle(m_left);
    }
    std::vector<std::size_t> take(std::size_t count) {
        std::vector<std::size_t> taken(m_left.end() - static_cast<std::ptrdiff_t>(count), m_left.end());
        m_left.resize(m_left.size() - count);
        return taken;
    }
    std::vector<HookRange> ranges(std::size_t count) {
        std::vector<HookRange> found;
        for (const std::size_t hook : take(count)) found.push_back({hook, hook});
        return found;
    }

  private:
    std::vector<std::size_t> m_left;
};

void draw_layout(Random& random, LoomProfile& profile) {
    profile.output = std::vector<OutputFormat>{OutputFormat::jc5, OutputFormat::ep,
                                               OutputFormat::raw}[random.between(0, 2)];
    for (std::size_t k = random.between(1, 3); k > 0; --k)
        profile.areas.push_back({std::string(random.between(0, 4), 'a'), random.between(1, 20)});
    if (profile.output == OutputFormat::ep) profile.areas.resize(1);  // its header knows one
    profile.areas.back().hooks += 20;
    for (const HookArea& area : profile.areas) profile.total_hooks += area.hooks;
    profile.areas_on_bytes = random.coin(), profile.least_bit_first = random.coin();
    profile.lifted_is_one = random.coin(), profile.pick_1_at_bottom = random.coin();
    profile.end_1_at_left = random.coin();
    profile.lead_in_picks = random.between(0, 3);
    if (profile.output == OutputFormat::ep) profile.function_bytes = random.between(0, 8);
    if (profile.output == OutputFormat::raw) profile.function_bytes = random.between(0, 3);
    if (random.coin()) profile.hook_permutation = Pool(random, profile.total_hooks).take(profile.total_hooks);
}

void draw_feeders(Random& random, LoomProfile& profile, Pool& pool) {
    const bool bits = profile.function_bytes > 0 && random.coin();
    profile.feeders = random.between(1, 6);
    const std::size_t kind = random.between(0, 2);
    profile.feeder_encoding = kind == 0   ? FeederEncoding::none
                              : kind == 1 ? bits ? FeederEncoding::one_hot : FeederEncoding::hooks
                              : bits      ? FeederEncoding::binary
                                          : FeederEncoding::binary_hooks;
    profile.feeders_per_pick = random.between(1, 2);
    const std::size_t places = feeder_places(profile);
    profile.feeder_hooks = bits ? Pool(random, 8 * profile.function_bytes).take(places) : pool.take(places);
}

void draw_harness(Random& random, LoomProfile& profile, Pool& pool) {
    profile.selvedge = pool.ranges(random.between(0, 3));
    profile.selvedge_weave = {"011", "100", "110"};
    profile.constant_on = pool.ranges(random.between(0, 2));
    profile.regulator_hooks = pool.take(random.between(0, 1));
    profile.hook_rule = static_cast<HookRule>(random.between(0, 3));
    const std::size_t body = random.between(3, 7);
    if (profile.hook_rule == HookRule::list)
        profile.hook_of_end = pool.take(body);
    else
        profile.body = pool.ranges(body);
    profile.repeats = random.between(1, 3);
}

void draw_cloth(Random& random, Drawn& drawn) {
    const LoomProfile& profile = drawn.profile;
    CardImage card(random.between(1, 6), random.between(1, most_ends(profile)));
    for (std::size_t pick = 0; pick < card.picks(); ++pick)
        for (std::size_t end = 0; end < card.ends(); ++end) card.set(pick, end, random.coin());
    drawn.design = design_of(card, {0}, profile.feeders);
    const bool binary = profile.feeder_encoding == FeederEncoding::binary ||
                        profile.feeder_encoding == FeederEncoding::binary_hooks;
    const std::size_t at_once = std::min(binary ? 1 : profile.feeders_per_pick, profile.feeders);
    drawn.design.weft.feeder_order.clear();
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        FeederSet set;
        for (const std::size_t feeder : Pool(random, profile.feeders).take(random.between(0, at_once)))
            set.push_back(static_cast<std::uint32_t>(feeder));
        drawn.design.weft.feeder_order.push_back(set);
        drawn.design.weft.take_up.push_back(random.coin());
    }
    const auto on_loom = Pool(random, profile.feeders).take(profile.feeders);
    for (std::size_t k = 0; k < on_loom.size(); ++k) drawn.map[static_cast<std::uint32_t>(k)] = on_loom[k];
}

Drawn draw(Random& random) {
    Drawn drawn;
    draw_layout(random, drawn.profile);
    Pool pool(random, drawn.profile.total_hooks);
    draw_feeders(random, drawn.profile, pool);
    draw_harness(random, drawn.profile, pool);
    draw_cloth(random, drawn);
    return drawn;
}

}  // namespace

TEST_CASE("any controller file decodes to the card, the lifts, the feeders and the name that were meant") {
    for_all([](Random& random) {
        const Drawn drawn = draw(random);
        const auto plan = plan_of(drawn.design, drawn.profile, drawn.map);
        REQUIRE(plan);
        const std::string wish(random.between(1, 12), 'n');
        const auto file = write_controller_file(*plan, drawn.profile, {wish, "a comment"});
        REQUIRE(file);
        const CardImage& card = *std::get<CardLeaf>(drawn.design.blocks.at("cloth")->source).card;
        const auto read = test_decoder(file->bytes, drawn.profile, card.ends());
        INFO((read ? "" : read.error().text()));
        REQUIRE(read);
        CHECK(read->card == card);
        CHECK(read->lifts == plan->lifts);
        CHECK(read->name == (drawn.profile.output == OutputFormat::raw ? "" : wish.substr(0, 8)));
        const Status same =
            check_controller_file(file->bytes, file->name, *plan, card, drawn.profile, test_decoder);
        INFO((same ? "" : same.error().text()));
        CHECK(same);
    });
}

TEST_CASE("a lift that is turned over anywhere in the records is found on reading back") {
    for_all([](Random& random) {
        Drawn drawn = draw(random);
        const auto plan = plan_of(drawn.design, drawn.profile, drawn.map);
        REQUIRE(plan);
        HookPlan other = *plan;
        const std::size_t pick = random.between(0, plan->lifts.picks() - 1);
        const std::size_t hook = random.between(0, plan->lifts.hooks() - 1);
        if (other.lifts.lifted(pick, hook)) return;
        other.lifts.lift(pick, hook);
        const auto file = write_controller_file(other, drawn.profile, {"n", ""});
        REQUIRE(file);
        const CardImage& card = *std::get<CardLeaf>(drawn.design.blocks.at("cloth")->source).card;
        CHECK_FALSE(check_controller_file(file->bytes, file->name, *plan, card, drawn.profile, test_decoder));
    });
}
