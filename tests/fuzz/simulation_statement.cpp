// What a simulation says that it found, from anywhere: refused with a reason, or a statement that reads as it
// was written and whose regions lie on the card.
#include "support/must.hpp"

#include <weave/wire/evidence.hpp>

using namespace weave;
using namespace weave::wire;
using fuzz::must;

namespace {

void must_lie_on_the_card(const SimulationStatement& statement) {
    for (const SimulatedRegion& region : statement.regions) {
        must(region.picks >= 1 && region.ends >= 1, "no region is empty");
        must(region.first_pick + region.picks <= statement.picks, "no region reaches beyond the last pick");
        must(region.first_end + region.ends <= statement.ends, "no region reaches beyond the last end");
    }
    const double share = covered_share(statement.regions, statement.picks, statement.ends);
    must(share >= 0 && share <= 1 + 1e-9, "a share is one");
    must(statement.regions.empty() || share > 0, "regions cover something");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto json = parse_json(fuzz::text_of(data, size));
    if (!json) return 0;
    const auto statement = read_simulation(*json);
    if (!statement) {
        must(!statement.error().message.empty(), "a refusal says why");
        return 0;
    }
    must_lie_on_the_card(*statement);
    const Json body = statement_body(*statement);
    const auto again = read_simulation(body);
    must(again && canonical_json(statement_body(*again)) == canonical_json(body),
         "a statement reads as it was written");
    return 0;
}
