#include <weave/samples/build.hpp>
#include <weave/samples/makers.hpp>

namespace weave::sample {

namespace {

Design one_layer(std::string title, std::string notes, std::string family,
                 std::map<std::string, std::int64_t> options) {
    Design design = cloth(std::move(title), std::move(notes), cotton("warp", "#e08a2c", 0.15, 50),
                          cotton("weft", "#8f959b", 0.15, 50));
    add(design, "repeat", preset(std::move(family), std::move(options)));
    return design;
}

}  // namespace

Design plain() {
    return one_layer("Plain weave", "Each end over one pick and under the next.", "plain", {});
}

Design twill_2_2() {
    return one_layer("2/2 twill", "Over two, under two, one end further on each pick.", "twill",
                     {{"up", 2}, {"down", 2}});
}

Design satin_5() {
    return one_layer("5-end satin", "The warp shows: each end binds under one pick in five.", "satin",
                     {{"size", 5}});
}

Design sateen_8() {
    return one_layer("8-end sateen", "The weft shows: each end lies over one pick in eight.", "sateen",
                     {{"size", 8}});
}

Design rib() {
    return one_layer("2/2 warp rib", "Plain weave with two picks in each shed.", "rib",
                     {{"first", 2}, {"second", 2}});
}

Design basket() {
    return one_layer("2/2 basket", "Plain weave of pairs of ends and picks.", "basket",
                     {{"ends", 2}, {"picks", 2}});
}

Design herringbone() {
    return one_layer("Herringbone", "A 2/2 twill that turns back with a clean cut after eight ends.",
                     "herringbone", {{"up", 2}, {"down", 2}, {"width", 8}});
}

}  // namespace weave::sample
