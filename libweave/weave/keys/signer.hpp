#pragma once

#include <weave/core/result.hpp>
#include <weave/keys/key.hpp>

#include <filesystem>
#include <string>

namespace weave {

/// What a machine whose simulations count signs with, and for whom.
struct Signer {
    KeyPair key;
    std::string site;  ///< that enrolled it; stands in every statement
    std::string name;  ///< what the site calls it
};

/// What lies beside the key's file.
struct SignerNote {
    std::string key;  ///< key_id()
    std::string site, name;
};

/// Where enrolling tells the site of a key: beside the key's file, with `.site` behind its name. Nothing in it is secret.
std::filesystem::path signer_note(const std::filesystem::path& key_file);

/// Writes that note: `{"format":"weave-signer","key":…,"name":…,"site":…,"version":1}`.
Status save_signer_note(const std::filesystem::path& key_file, const SignerNote& note);

/// Reads the key of a machine, as load_server_key() does, and its note. Errors: the note is missing (the machine is to be
/// enrolled with `loomlink signer enrol`), is none, or is of another key.
Result<Signer> load_signer(const std::filesystem::path& key_file);

}  // namespace weave
