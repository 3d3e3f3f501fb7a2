// EP files from anywhere, for small looms.
#include "support/controller.hpp"
#include "support/must.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    weave::fuzz::try_controller(weave::fuzz::text_of(data, size), weave::OutputFormat::ep);
    return 0;
}
