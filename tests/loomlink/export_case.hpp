#pragma once

// A small cloth, a small loom and hand-typed bytes for the tests of export.

#include <weave/design/evaluate.hpp>
#include <weave/loom/pick_table.hpp>
#include <weave/loom/profile.hpp>

#include <catch2/catch.hpp>

#include <loomlink/export/hook_plan.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace weave::testing {

/// `81 FE 'abc' 00*3`: bytes in hexadecimal, texts in quotes, counts behind a star.
inline std::string bytes_of(const std::string& typed) {
    std::istringstream words(typed);
    std::string out, word;
    while (words >> word) {
        if (word.front() == '\'') {
            out += word.substr(1, word.size() - 2);
            continue;
        }
        const std::size_t star = word.find('*');
        const std::size_t times = star == std::string::npos ? 1 : std::stoul(word.substr(star + 1));
        out.append(times, static_cast<char>(std::stoi(word.substr(0, star), nullptr, 16)));
    }
    return out;
}

/// X = the end is lifted; one text a pick, from the first.
inline CardImage card_of(const std::vector<std::string>& picks) {
    CardImage card(picks.size(), picks.front().size());
    for (std::size_t k = 0; k < picks.size(); ++k)
        for (std::size_t end = 0; end < picks[k].size(); ++end) card.set(k, end, picks[k][end] != 'X');
    return card;
}

/// A design of this card whose feeders, from 1, come in this order; 0 is a pick without weft.
inline Design design_of(const CardImage& card, const std::vector<std::uint32_t>& feeder_order = {1},
                        std::size_t feeders = 6) {
    Design design;
    design.title = "cloth";
    design.root = "cloth";
    CardLeaf leaf;
    leaf.card = std::make_shared<const CardImage>(card);
    design.blocks["cloth"] = std::make_shared<const Node>(Node{leaf, {}});
    const YarnType yarn = design.weft.yarns.front();
    design.weft.yarns.clear(), design.weft.feeders.clear(), design.weft.feeder_order.clear();
    for (std::size_t k = 0; k < feeders; ++k) {
        design.weft.yarns.push_back(yarn);
        design.weft.yarns.back().name = "yarn " + std::to_string(k + 1);
        design.weft.feeders.push_back({"feeder " + std::to_string(k + 1), static_cast<std::uint32_t>(k)});
    }
    for (const std::uint32_t feeder : feeder_order)
        design.weft.feeder_order.push_back(feeder == 0 ? FeederSet{} : FeederSet{feeder - 1});
    return design;
}

/// Each feeder of the design on the loom's of the same number.
inline FeederMap straight_map(std::size_t feeders) {
    FeederMap map;
    for (std::size_t k = 0; k < feeders; ++k) map[static_cast<std::uint32_t>(k)] = k;
    return map;
}

/// A loom of so many hooks in one area, all of them body, with one feeder that a hand picks.
inline LoomProfile plain_loom(OutputFormat output, std::size_t hooks) {
    LoomProfile profile;
    profile.name = "test";
    profile.output = output;
    profile.areas = {{"all", hooks}};
    profile.total_hooks = hooks;
    profile.body = {{0, hooks - 1}};
    profile.function_bytes = output == OutputFormat::ep ? 4 : 0;
    return profile;
}

inline Result<loomlink::HookPlan> plan_of(const Design& design, const LoomProfile& profile,
                                          const FeederMap& map) {
    const Evaluation cloth = Evaluator().evaluate(design).value();
    return loomlink::plan_hooks(design, cloth.block->card_image(), pick_table(design, *cloth.block), profile,
                                map);
}

/// The lifted hooks of a pick.
inline std::vector<std::size_t> lifted(const loomlink::HookPlan& plan, std::size_t pick) {
    std::vector<std::size_t> hooks;
    for (std::size_t hook = 0; hook < plan.lifts.hooks(); ++hook)
        if (plan.lifts.lifted(pick, hook)) hooks.push_back(hook);
    return hooks;
}

/// An error whose text has these words.
template <class Outcome>
void expect_refusal(const Outcome& outcome, const std::string& words) {
    REQUIRE_FALSE(outcome);
    INFO(outcome.error().text());
    CHECK(outcome.error().text().find(words) != std::string::npos);
}

}  // namespace weave::testing
