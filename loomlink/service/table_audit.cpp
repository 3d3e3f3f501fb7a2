#include <loomlink/service/table.hpp>

namespace weave::loomlink {

std::vector<ApiRoute> audit_table() {
    constexpr std::int64_t most = std::int64_t{1} << 40;
    const Access engineer = access::only({PersonRole::engineer});
    const auto size = optional({"size", "The size of the log to prove it in; its last head's if missing",
                                FieldKind::integer, true, 1, most});
    return {
        {"events",
         "GET",
         "/events",
         engineer,
         "Records of the log, oldest first",
         "`events`: `seq`, `at`, `actor`, `kind`, `subject`, `reason`, `signed`, `record`",
         {optional({"from", "The first record, from 0", FieldKind::integer, true, 0, most}),
          optional({"limit", "How many at most", FieldKind::integer, true, 1, 1000}),
          optional({"design", "Only records about this design", FieldKind::text, true, 1, 64})}},
        {"audit.head", "GET", "/audit/head", engineer, "The signed head of the log",
         "`site`, `size`, `root`, `at`, `signature`"},
        {"audit.inclusion",
         "GET",
         "/audit/inclusion",
         engineer,
         "That a record is in the log",
         "`path`: hashes",
         {{"seq", "The record", FieldKind::integer, true, 0, most}, size}},
        {"audit.consistency",
         "GET",
         "/audit/consistency",
         engineer,
         "That the log only grew",
         "`path`: hashes",
         {{"from", "The size that the log had", FieldKind::integer, true, 1, most}, size}},
        {"audit.bundle",
         "GET",
         "/audit/bundle",
         engineer,
         "The whole log with its signed head, to verify offline",
         "The bundle",
         {},
         {},
         "application/octet-stream"},
        {"openapi", "GET", "/openapi.json", access::anyone(), "This document", "OpenAPI 3.1"},
    };
}

}  // namespace weave::loomlink
