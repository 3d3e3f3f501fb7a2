// A record of the log, or a signed head of it, from anywhere: refused with a reason, or one that has these
// bytes and no others.
#include "support/must.hpp"

#include <loomlink/audit/head.hpp>
#include <loomlink/audit/record.hpp>

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    if (const auto record = parse_record(text)) {
        const auto written = record_bytes(*record);
        must(written && *written == text, "a record has one sequence of bytes");
        must(!statement_bytes(record->statement).empty(), "a statement can be signed");
    } else {
        must(!record.error().message.empty(), "a refusal says why");
    }
    if (const auto head = parse_signed_head(text)) {
        must(signed_head_bytes(*head) == text, "a head has one sequence of bytes");
        must(head->head.size >= 1, "a head speaks of a record");
    } else {
        must(!head.error().message.empty(), "a refusal says why");
    }
    return 0;
}
