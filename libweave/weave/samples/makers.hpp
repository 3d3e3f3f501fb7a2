#pragma once

#include <weave/design/design.hpp>

/// The makers of the shipped designs, one file a group; the registry in samples.cpp lists them.
namespace weave::sample {

// basic.cpp: one layer, by rule
Design plain();
Design twill_2_2();
Design satin_5();
Design sateen_8();
Design rib();
Design basket();
Design herringbone();

// layered.cpp: two layers and more
Design satin_e();
Design twill_g();
Design three_colour_stencil();
Design layer_to_layer();
Design angle_interlock_a();
Design angle_interlock_b();
Design orthogonal();
Design stitched_layers();

// spatial.cpp: cloths that open or stand up
Design hexagon_tubes();
Design tl013_wrong();
Design tl013_corrected();
Design pocket();
Design i_beam();

// shoes.cpp, shoe_adult.cpp
Design shoe_baby();
Design shoe_toddler();
Design shoe_adult();

}  // namespace weave::sample
