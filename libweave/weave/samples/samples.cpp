#include <weave/samples/samples.hpp>

#include <weave/samples/makers.hpp>

#include <algorithm>

namespace weave {

namespace {

const std::string by_rule = " A traditional weave, made by rule.";
const std::string not_printed = " The paper does not print its card legibly; built from its description.";

std::vector<Sample> library() {
    return {
        {"plain", "Plain weave", "Over one, under one: the simplest design there is, one preset." + by_rule, "tc2", sample::plain},
        {"twill-2-2", "2/2 twill", "Diagonal lines." + by_rule, "tc2", sample::twill_2_2},
        {"satin-5", "5-end satin", "A smooth warp face." + by_rule, "tc2", sample::satin_5},
        {"sateen-8", "8-end sateen", "A smooth weft face." + by_rule, "tc2", sample::sateen_8},
        {"rib", "2/2 warp rib", "Ribs across the cloth." + by_rule, "tc2", sample::rib},
        {"basket", "2/2 basket", "Plain weave of pairs, also called hopsack." + by_rule, "tc2", sample::basket},
        {"herringbone", "Herringbone", "A twill that turns." + by_rule, "tc2", sample::herringbone},
        {"satin-e", "Satin E: two-layer satin",
         "Figure 11's first cloth: two satins back to back, stitched." + not_printed, "tc2", sample::satin_e},
        {"twill-g", "Twill G: two-layer twill",
         "Figure 11's second cloth, with its diagonal dent." + not_printed, "tc2", sample::twill_g},
        {"three-colour-stencil", "Three-colour stencil",
         "Figure 1's cloth: three two-layer satins merged by a stencil image." + not_printed, "tc2",
         sample::three_colour_stencil},
        {"layer-to-layer", "Layer to layer", "Figure 10: ends that bind neighbouring levels." + not_printed,
         "tc2", sample::layer_to_layer},
        {"angle-interlock-a", "Angle interlock A",
         "Figure 10: ends on a slant through the thickness." + not_printed, "tc2", sample::angle_interlock_a},
        {"angle-interlock-b", "Angle interlock B",
         "Figure 10: slanting binders and straight stuffers." + not_printed, "tc2",
         sample::angle_interlock_b},
        {"orthogonal", "Orthogonal", "Figure 10: upright binders and straight stuffers." + not_printed, "tc2",
         sample::orthogonal},
        {"stitched-layers", "Four stitched layers",
         "Plain-weave layers stitched point by point. Not in the paper.", "tc2", sample::stitched_layers},
        {"hexagon-tubes", "Hexagon tubes",
         "Figure 10: layers that join and part to six-sided cells." + not_printed, "tc2",
         sample::hexagon_tubes},
        {"tl013-wrong", "TL013, wrong",
         "Figure 12: a zigzag layer with the error that makes it lean." + not_printed, "tc2",
         sample::tl013_wrong},
        {"tl013-corrected", "TL013, corrected",
         "Figure 12: the same with the crossings flipped that were wrong." + not_printed, "tc2",
         sample::tl013_corrected},
        {"pocket", "Pocket",
         "Figure 13: closed on three sides, two of them by the shuttle's turns." + not_printed, "tc2",
         sample::pocket},
        {"i-beam", "I-beam", "Figure 14: a web made by turns in the middle of the cloth." + not_printed,
         "tc2", sample::i_beam},
        {"shoe-baby", "Baby shoe",
         "Figure 4: two plain-weave layers, seven blocks A to G, three stencils." + not_printed, "tc2",
         sample::shoe_baby},
        {"shoe-toddler", "Toddler shoe",
         "Figure 15: nine blocks, three stencils, three layers of ends, renumbered wefts." + not_printed,
         "tc2", sample::shoe_toddler},
        {"shoe-adult", "Adult shoe",
         "Figure 17: a full-size shoe on 2,400 ends; every combination of sole, insole and "
                       "upper that the shoe needs is a block of its own." + not_printed,
         "ep-2688", sample::shoe_adult},
    };
}

}  // namespace

const std::vector<Sample>& samples() {
    static const std::vector<Sample> all = library();
    return all;
}

const Sample* find_sample(std::string_view name) {
    const std::vector<Sample>& all = samples();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Sample& sample) { return sample.name == name; });
    return found == all.end() ? nullptr : &*found;
}

}  // namespace weave
