// BMP files from anywhere, as cards and as stencils.
#include "support/must.hpp"
#include "support/picture.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    weave::fuzz::try_picture(weave::fuzz::text_of(data, size), weave::BitmapFormat::bmp);
    return 0;
}
