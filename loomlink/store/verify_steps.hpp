#pragma once

#include <weave/sql/database.hpp>

#include <loomlink/store/store.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What the steps of a verification share.
struct Inspection {
    sql::Connection& connection;
    const StoreTrust& trust;
    std::vector<AuditFinding> findings;

    void find(std::string place, std::string cause) {
        findings.push_back({{}, std::move(place), std::move(cause)});
    }
    void find_in(Seq seq, std::string cause) {
        findings.push_back({seq, "record " + std::to_string(seq), std::move(cause)});
    }
};

/// The records, their chain, the tree and its heads.
Status inspect_log(Inspection& inspection);

}  // namespace weave::loomlink
