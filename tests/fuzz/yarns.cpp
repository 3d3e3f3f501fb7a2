// A `.yarns` file from anywhere, and measured centrelines: refused with a reason, or yarns that write and
// read as themselves.
#include "support/must.hpp"

#include <weave/sim/inspect.hpp>
#include <weave/sim/measured.hpp>
#include <weave/sim/yarns_file.hpp>

using namespace weave;
using fuzz::must;

namespace {

void try_measured(std::string_view text) {
    const auto yarns = read_measured(text);
    if (!yarns) {
        must(!yarns.error().message.empty(), "a refusal says why");
        return;
    }
    must(!yarns->empty(), "there is a yarn");
    for (const MeasuredYarn& yarn : *yarns) {
        must(yarn.places.size() >= 2, "a yarn has two points");
        for (const Vec3& place : yarn.places) must(place.allFinite(), "places are finite");
    }
}

/// Whatever places and crossings a file has, looking them over ends, and what it says can be told.
void try_inspection(const Yarns& yarns) {
    if (yarns.crossings.size() > 100 || yarns.yarns.size() > 100) return;
    const auto found = inspect(yarns);
    if (!found) {
        must(!found.error().message.empty(), "a refusal says why");
        return;
    }
    must(!inspection_json(yarns, *found).empty() && !inspection_text(yarns, *found).empty(), "there is something to tell");
}

void check(const Yarns& yarns) {
    for (const SimulatedYarn& yarn : yarns.yarns) {
        const std::size_t points = yarn.spline.control.size();
        must(yarn.spline.segments() > 0, "a yarn has a length");
        must(yarn.planned.size() == points && yarn.strain.size() == points && yarn.contact_N.size() == points,
             "every control point has its numbers");
        for (const Vec3& place : yarn.spline.control) must(place.allFinite(), "places are finite");
        must(yarn.radius_mm > 0, "a yarn has a radius");
    }
    for (const Crossing& crossing : yarns.crossings) {
        must(crossing.weft < yarns.yarns.size() && crossing.warp < yarns.yarns.size(),
             "yarns that cross are there");
    }
    try_inspection(yarns);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes = fuzz::text_of(data, size);
    try_measured(bytes);
    const auto yarns = read_yarns(bytes);
    if (!yarns) {
        must(!yarns.error().message.empty(), "a refusal says why");
        return 0;
    }
    check(*yarns);
    const auto written = write_yarns(*yarns);
    must(static_cast<bool>(written), "what was read can be written");
    const auto again = read_yarns(*written);
    must(static_cast<bool>(again), "what was written can be read");
    const auto twice = write_yarns(*again);
    must(twice && *twice == *written, "writing again gives the same bytes");
    return 0;
}
