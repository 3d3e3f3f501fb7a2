#pragma once

#include <weave/wire/evidence.hpp>

#include <string>

namespace weave::loomlink {

/// Evidence that a machine has signed, ready to be filed, and what it says.
struct EvidenceToFile {
    wire::SignedEvidence evidence;
    wire::SimulationStatement statement;

    /// Such as `a simulation at standard, at rest`.
    [[nodiscard]] std::string words() const;
};

/// Reads what a file says that weave::wire::write_evidence() made. Errors (bad_input) name the file.
Result<EvidenceToFile> load_evidence(const std::string& file);

/// The same of bytes that were read already.
Result<EvidenceToFile> evidence_from(std::string_view bytes);

}  // namespace weave::loomlink
