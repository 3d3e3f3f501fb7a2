// Random cloths on random looms: the readers of weave/io, and a decoder of these tests alone, read what was
// meant; no damaged byte passes.

#include "../support/random.hpp"
#include "export_case.hpp"
#include "export_decoder.hpp"

#include <loomlink/export/read_back.hpp>

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

/// A name or comment as people type them, blanks anywhere; one letter at least.
std::string draw_text(Random& random, std::size_t most) {
    std::string text(random.between(1, most), 'n');
    for (char& c : text) c = " A7~"[random.between(0, 3)];
    text[0] = 'n';
    return text;
}

std::string without_blanks_behind(std::string text) {
    while (text.ends_with(' ')) text.pop_back();
    return text;
}

/// One file of a random cloth for a random loom, and what it was meant to say.
struct Written {
    Drawn drawn;
    HookPlan plan;
    CardImage card;
    InFileNames wish;
    WrittenFile file;
};

Written write(Random& random) {
    Written written{draw(random), {}, {}, {draw_text(random, 12), draw_text(random, 20)}, {}};
    const Drawn& drawn = written.drawn;
    written.plan = plan_of(drawn.design, drawn.profile, drawn.map).value();
    written.card = *std::get<CardLeaf>(drawn.design.blocks.at("cloth")->source).card;
    written.file = write_controller_file(written.plan, drawn.profile, written.wish).value();
    return written;
}

/// The feeders of the loom that the design's picks take, worked out apart from the plan.
std::vector<std::vector<std::size_t>> meant_feeders(const Drawn& drawn) {
    std::vector<std::vector<std::size_t>> all;
    for (const FeederSet& set : drawn.design.weft.feeder_order) {
        std::vector<std::size_t> feeders;
        for (const std::uint32_t feeder : set) feeders.push_back(drawn.map.at(feeder));
        std::sort(feeders.begin(), feeders.end());
        if (drawn.profile.feeder_encoding == FeederEncoding::none) feeders.clear();
        all.push_back(feeders);
    }
    return all;
}

void check_read(const Result<DecodedFile>& read, const Written& written) {
    INFO((read ? "" : read.error().text()));
    REQUIRE(read);
    for (const std::string& oddity : read->oddities) UNSCOPED_INFO(oddity);
    const OutputFormat output = written.drawn.profile.output;
    const bool named = output != OutputFormat::raw;
    REQUIRE(read->names.name == (named ? without_blanks_behind(written.wish.name.substr(0, 8)) : ""));
    REQUIRE(read->names.comment ==
            (output == OutputFormat::jc5 ? without_blanks_behind(written.wish.comment) : ""));
    REQUIRE(read->card == written.card);
    REQUIRE(read->lifts == written.plan.lifts);
    REQUIRE(read->feeders == meant_feeders(written.drawn));
    REQUIRE(read->oddities.empty());
}

Status proof(const Result<DecodedFile>& read, const Written& written) {
    if (!read) return read.error();
    return check_decoded(*read, written.file.names, written.plan, written.card, written.drawn.profile);
}

}  // namespace

TEST_CASE("any controller file decodes to the card, the lifts, the feeders and the names that were meant") {
    for_all([](Random& random) {
        const Written written = write(random);
        const LoomProfile& profile = written.drawn.profile;
        check_read(decode_controller_file(written.file.bytes, profile, written.card.ends()), written);
        check_read(test_decoder(written.file.bytes, profile, written.card.ends()), written);
        REQUIRE(check_controller_file(written.file.bytes, written.file.names, written.plan, written.card,
                                      profile));
    });
}

TEST_CASE("one damaged byte anywhere in a controller file is refused, or differs, or is told") {
    for_all([](Random& random) {
        const Written written = write(random);
        std::string bytes = written.file.bytes;
        // An EP file is padding for the most part: every other try is in its first bytes.
        const std::size_t most = random.coin() ? bytes.size() : std::min<std::size_t>(bytes.size(), 80);
        const std::size_t at = random.between(0, most - 1);
        const std::size_t flip =
            random.coin() ? std::size_t{1} << random.between(0, 7) : random.between(1, 255);
        bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(flip));
        INFO("byte " << at << " of " << bytes.size() << " ^ " << flip);
        const auto read = decode_controller_file(bytes, written.drawn.profile, written.card.ends());
        REQUIRE_FALSE(proof(read, written));
    });
}

TEST_CASE("a file that is cut, or that goes on, is not proved") {
    for_all(
        [](Random& random) {
            const Written written = write(random);
            std::string bytes = written.file.bytes;
            if (random.coin())
                bytes.resize(random.between(0, bytes.size() - 1));
            else
                bytes.append(random.between(1, 9), static_cast<char>(random.between(0, 255)));
            REQUIRE_FALSE(
                proof(decode_controller_file(bytes, written.drawn.profile, written.card.ends()), written));
        },
        property_cases() / 4);
}

TEST_CASE("a lift that is turned over anywhere in the records is found on reading back") {
    for_all([](Random& random) {
        const Written written = write(random);
        HookPlan other = written.plan;
        const std::size_t pick = random.between(0, other.lifts.picks() - 1);
        const std::size_t hook = random.between(0, other.lifts.hooks() - 1);
        if (other.lifts.lifted(pick, hook)) return;
        other.lifts.lift(pick, hook);
        const LoomProfile& profile = written.drawn.profile;
        const auto file = write_controller_file(other, profile, written.wish);
        REQUIRE(file);
        REQUIRE_FALSE(check_controller_file(file->bytes, file->names, written.plan, written.card, profile));
    });
}
