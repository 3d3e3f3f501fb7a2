// Signed evidence from anywhere: refused with a reason, or a document that has these bytes alone, with a statement that
// can be read and the report that it names.
#include "support/must.hpp"

#include <weave/wire/evidence.hpp>

using namespace weave;
using namespace weave::wire;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes = fuzz::text_of(data, size);
    if (const auto statement = statement_of_result(bytes, Instant{}))
        must(statement->report_sha256 == sha256(bytes), "a statement names the report that it was made of");
    const auto evidence = read_evidence(bytes);
    if (!evidence) {
        must(!evidence.error().message.empty(), "a refusal says why");
        return 0;
    }
    must(write_evidence(*evidence) == bytes, "a document has one sequence of bytes");
    const auto statement = read_simulation(evidence->statement);
    must(statement && statement->report_sha256 == sha256(evidence->report), "the report is the one that was signed");
    return 0;
}
