#include <weave/samples/samples.hpp>

#include <weave/samples/makers.hpp>

#include <algorithm>

namespace weave {

namespace {

const std::string by_rule = "A traditional weave, made by rule. ";
const std::string not_printed = "The paper does not print its card legibly; built from its description. ";

std::vector<Sample> library() {
    return {
        {"plain", "Plain weave", by_rule + "The simplest design there is: one preset.", "tc2", sample::plain},
        {"twill-2-2", "2/2 twill", by_rule + "Diagonal lines.", "tc2", sample::twill_2_2},
        {"satin-5", "5-end satin", by_rule + "A smooth warp face.", "tc2", sample::satin_5},
        {"sateen-8", "8-end sateen", by_rule + "A smooth weft face.", "tc2", sample::sateen_8},
        {"rib", "2/2 warp rib", by_rule + "Ribs across the cloth.", "tc2", sample::rib},
        {"basket", "2/2 basket", by_rule + "Also called hopsack.", "tc2", sample::basket},
        {"herringbone", "Herringbone", by_rule + "A twill that turns.", "tc2", sample::herringbone},
        {"satin-e", "Satin E: two-layer satin",
         not_printed + "Figure 11's first cloth: two satins back to back, stitched.", "tc2", sample::satin_e},
        {"twill-g", "Twill G: two-layer twill",
         not_printed + "Figure 11's second cloth, with its diagonal dent.", "tc2", sample::twill_g},
        {"three-colour-stencil", "Three-colour stencil",
         not_printed + "Figure 1's cloth: three two-layer satins merged by a stencil image.", "tc2",
         sample::three_colour_stencil},
        {"layer-to-layer", "Layer to layer", not_printed + "Figure 10: ends that bind neighbouring levels.",
         "tc2", sample::layer_to_layer},
        {"angle-interlock-a", "Angle interlock A",
         not_printed + "Figure 10: ends on a slant through the thickness.", "tc2", sample::angle_interlock_a},
        {"angle-interlock-b", "Angle interlock B",
         not_printed + "Figure 10: slanting binders and straight stuffers.", "tc2",
         sample::angle_interlock_b},
        {"orthogonal", "Orthogonal", not_printed + "Figure 10: upright binders and straight stuffers.", "tc2",
         sample::orthogonal},
        {"stitched-layers", "Four stitched layers",
         "Not in the paper: plain-weave layers stitched point by point.", "tc2", sample::stitched_layers},
        {"hexagon-tubes", "Hexagon tubes",
         not_printed + "Figure 10: layers that join and part to six-sided cells.", "tc2",
         sample::hexagon_tubes},
        {"tl013-wrong", "TL013, wrong",
         not_printed + "Figure 12: a zigzag layer with the error that makes it lean.", "tc2",
         sample::tl013_wrong},
        {"tl013-corrected", "TL013, corrected",
         not_printed + "Figure 12: the same with the crossings flipped that were wrong.", "tc2",
         sample::tl013_corrected},
        {"pocket", "Pocket",
         not_printed + "Figure 13: closed on three sides, two of them by the shuttle's turns.", "tc2",
         sample::pocket},
        {"i-beam", "I-beam", not_printed + "Figure 14: a web made by turns in the middle of the cloth.",
         "tc2", sample::i_beam},
        {"shoe-baby", "Baby shoe",
         not_printed + "Figure 4: two plain-weave layers, seven blocks A to G, three stencils.", "tc2",
         sample::shoe_baby},
        {"shoe-toddler", "Toddler shoe",
         not_printed + "Figure 15: nine blocks, three stencils, three layers of ends, renumbered wefts.",
         "tc2", sample::shoe_toddler},
        {"shoe-adult", "Adult shoe",
         not_printed + "Figure 17: a full-size shoe on 2,400 ends; every combination of sole, insole and "
                       "upper that the shoe needs is a block of its own.",
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
