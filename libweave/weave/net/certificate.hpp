#pragma once

#include <weave/core/result.hpp>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace weave::net {

/// Where a server's certificate (PEM, with those that lead to its root, if any) and its private key lie.
struct TlsFiles {
    std::filesystem::path certificate;
    std::filesystem::path key;
};

/// What a certificate says.
struct CertificateFacts {
    std::string fingerprint;         ///< SHA-256 of its DER form, 64 lower-case hexadecimal characters
    std::vector<std::string> names;  ///< host names and addresses it stands for
    std::chrono::system_clock::time_point from, until;
};

/// Whether a certificate can stand for it: a host name, or an IP address.
bool can_be_certified(const std::string& name);

/// Makes a key (ECDSA P-256) and a certificate for these host names and IP addresses, signed by itself and
/// valid for 825 days. Both files appear whole or not at all; the key first, readable by its owner alone.
/// Errors: usage for no name or one that is neither host name nor address; refused if either file is there
/// already; system.
Result<CertificateFacts> make_certificate(const TlsFiles& files, const std::vector<std::string>& names);

/// What the first certificate of a PEM file says. Errors: unreadable, no certificate.
Result<CertificateFacts> read_certificate(const std::filesystem::path& certificate);

}  // namespace weave::net
