// A configuration of the service from anywhere: refused with a reason, or one that can be served with.
#include "support/must.hpp"

#include <loomlink/commands/config.hpp>

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto config = parse_config(fuzz::text_of(data, size));
    if (!config) {
        must(!config.error().message.empty(), "a refusal says why");
        return 0;
    }
    must(static_cast<bool>(check_config(*config)), "what was read can be served with");
    must(config->workers >= 1 && config->workers <= 64, "the number of workers has its bounds");
    must(!client_hosts(*config).empty(), "clients have a name to come to");
    return 0;
}
