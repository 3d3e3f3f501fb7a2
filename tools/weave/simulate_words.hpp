#pragma once

#include <weave/block/block.hpp>
#include <weave/curve/cloth_curves.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/plan.hpp>

#include <string>
#include <vector>

/// What the words behind the options of `weave simulate` mean, and a plan in words. Errors name the option as it was written.
namespace weave::program {

/// `warp.strain=1.01`: a number of the scene, for this run only.
Status set_number(Scene& scene, const std::string& text);

/// `x=frozen`, `y=relaxing:0.2`: the rim in one direction, for this run only; a relaxing one goes into the request.
Status set_boundary(Scene& scene, sim::SimulationRequest& request, const std::string& text);

/// `pick:4`, `end:7` or the crossing `4,7`: held at its planned place.
Status add_pin(Scene& scene, sim::SimulationRequest& request, const Block& block, const std::string& text);

/// `sphere:X,Y,Z,RADIUS,STRENGTH` in mm and N/mm, or `none`, which takes away those of the scene.
Status add_field(Scene& scene, const std::string& text);

/// `picks:1-8,ends:3-12`, from 1: the rows and columns that hold them.
Result<Region> parse_region(const std::string& text, const Block& block);

/// `4,7` for each flip, picks and ends from 1, in their order: what each crossing is to be. Errors: one that is not legal
/// once those before it are made, with the yarns in the way.
Result<std::vector<Flip>> parse_flips(const std::vector<std::string>& texts, const Block& block);

/// What a plan does and saves, a line each.
std::string in_words(const std::vector<sim::PlanLine>& lines);

}  // namespace weave::program
