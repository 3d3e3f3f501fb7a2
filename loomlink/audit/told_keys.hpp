#pragma once

#include <weave/keys/key.hpp>

#include <map>
#include <string>
#include <string_view>

namespace weave::loomlink {

/// A public key as the record tells it by which its holder got it.
struct ToldPublicKey {
    PublicKey key{};
    std::string holder;  ///< a person, or a machine
};

using ToldPublicKeys = std::map<std::string, ToldPublicKey>;

/// The keys of people and machines that the records of a bundle hand out, by their ids: in `person.joined` and
/// `signer.enrolled`. Revoked ones too, since they counted once. A record that cannot be read, or whose id is
/// not that of its key, hands out none. Whoever trusts the log's key can judge by them all signatures of the
/// log, those of designers and engineers as well, whom no trust document lists. Reads any bytes.
ToldPublicKeys told_keys(std::string_view bundle);

}  // namespace weave::loomlink
