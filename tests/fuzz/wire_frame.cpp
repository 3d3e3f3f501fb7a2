// A frame from anywhere: refused with its place, or one that is written as it was read.
#include "support/must.hpp"

#include <weave/wire/frame.hpp>

using namespace weave;
using namespace weave::wire;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes = fuzz::text_of(data, size);
    const auto frame = decode_frame(bytes);
    if (!frame) {
        must(!frame.error().message.empty() && !frame.error().where.empty(), "a refusal says why and where");
        return 0;
    }
    std::size_t points = 0;
    for (const std::uint32_t count : frame->counts) {
        must(count > 0, "a yarn has a point");
        points += count;
    }
    must(points == frame->points.size(), "every point is a yarn's");
    for (const Vec3& place : frame->points)
        must(place.allFinite() && place.cwiseAbs().maxCoeff() <= farthest_mm, "places lie within reach");
    const auto again = encode_frame(*frame);
    must(again && *again == bytes, "a frame has one sequence of bytes");
    return 0;
}
