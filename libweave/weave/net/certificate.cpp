#include <weave/net/certificate.hpp>

#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <memory>
#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

namespace weave::net {

namespace {

namespace fs = std::filesystem;

constexpr long seconds_a_day = 86400;
constexpr long days_valid = 825;  // more than that, and browsers refuse it
constexpr std::uint64_t most_certificate_bytes = 1 << 20;

template <auto release>
struct Release {
    template <class T>
    void operator()(T* object) const {
        release(object);
    }
};
using Key = std::unique_ptr<EVP_PKEY, Release<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Release<X509_free>>;
using Memory = std::unique_ptr<BIO, Release<BIO_free_all>>;
using Extension = std::unique_ptr<X509_EXTENSION, Release<X509_EXTENSION_free>>;
using Names = std::unique_ptr<GENERAL_NAMES, Release<GENERAL_NAMES_free>>;

Error openssl_fault(const std::string& action) {
    return system_fault("cannot " + action);
}

bool is_address(const std::string& name) {
    std::array<unsigned char, 16> bytes{};
    return ::inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 ||
           ::inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

bool is_letter_or_digit(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool is_label(std::string_view label) {
    return !label.empty() && label.size() <= 63 && is_letter_or_digit(label.front()) && is_letter_or_digit(label.back()) &&
           std::ranges::all_of(label, [](char c) { return is_letter_or_digit(c) || c == '-'; });
}

/// Labels with points between, the last of them not a number, or it would be an address (RFC 1123, 2.1).
bool is_host_name(std::string_view name) {
    if (name.size() > 253) return false;
    while (true) {
        const std::size_t point = name.find('.');
        const std::string_view label = name.substr(0, point);
        if (!is_label(label)) return false;
        if (point == std::string_view::npos) return !std::ranges::all_of(label, [](char c) { return c >= '0' && c <= '9'; });
        name.remove_prefix(point + 1);
    }
}

std::string content_of(BIO* memory) {
    const char* bytes = nullptr;
    const long size = BIO_get_mem_data(memory, &bytes);
    return {bytes, static_cast<std::size_t>(size)};
}

bool add_extension(X509* certificate, int kind, const std::string& value) {
    X509V3_CTX context;
    X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
    const Extension extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
    return extension && X509_add_ext(certificate, extension.get(), -1) == 1;
}

bool set_serial(X509* certificate) {
    std::array<unsigned char, 16> random{};
    if (RAND_bytes(random.data(), random.size()) != 1) return false;
    random[0] = static_cast<unsigned char>((random[0] & 0x7f) | 0x40);  // positive, and as long as it looks
    BIGNUM* const number = BN_bin2bn(random.data(), random.size(), nullptr);
    const bool set =
        number != nullptr && BN_to_ASN1_INTEGER(number, X509_get_serialNumber(certificate)) != nullptr;
    BN_free(number);
    return set;
}

Result<Certificate> signed_by_itself(EVP_PKEY* key, const std::vector<std::string>& names) {
    Certificate certificate(X509_new());
    std::string alternatives;
    for (const std::string& name : names)
        alternatives +=
            (alternatives.empty() ? "" : ",") + std::string(is_address(name) ? "IP:" : "DNS:") + name;
    constexpr std::string_view title = "weave service";  // what counts are the alternative names
    X509_NAME* const subject = X509_get_subject_name(certificate.get());
    const bool made =
        X509_set_version(certificate.get(), X509_VERSION_3) == 1 && set_serial(certificate.get()) &&
        X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -3600) != nullptr &&  // clocks differ
        X509_gmtime_adj(X509_getm_notAfter(certificate.get()), days_valid * seconds_a_day - 3601) !=
            nullptr &&
        X509_set_pubkey(certificate.get(), key) == 1 &&
        X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_UTF8,
                                   reinterpret_cast<const unsigned char*>(title.data()),
                                   static_cast<int>(title.size()), -1, 0) == 1 &&
        X509_set_issuer_name(certificate.get(), subject) == 1 &&
        add_extension(certificate.get(), NID_subject_key_identifier, "hash") &&
        add_extension(certificate.get(), NID_basic_constraints, "critical,CA:FALSE") &&
        add_extension(certificate.get(), NID_key_usage, "critical,digitalSignature") &&
        add_extension(certificate.get(), NID_ext_key_usage, "serverAuth") &&
        add_extension(certificate.get(), NID_subject_alt_name, alternatives) &&
        X509_sign(certificate.get(), key, EVP_sha256()) > 0;
    if (!made) return openssl_fault("make a certificate");
    return certificate;
}

/// Writes a new file whole or not at all; `mode` holds from its first moment.
Status write_new_file(const fs::path& path, std::string_view bytes, mode_t mode) {
    const auto fault = [&] {
        return system_fault(std::string("cannot write: ") + std::strerror(errno), path.string());
    };
    const fs::path part = path.string() + ".part-" + std::to_string(::getpid());
    const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode);
    if (file < 0) return fault();
    bool done = ::fchmod(file, mode) == 0;
    while (done && !bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        done = written > 0;
        if (done) bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    done = done && ::fsync(file) == 0;
    Status status;
    if (!done || ::link(part.c_str(), path.c_str()) != 0)
        status = fault();  // a link replaces nothing, a rename would
    ::close(file);
    ::unlink(part.c_str());
    return status;
}

void flush_folder_of(const fs::path& path) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const int number = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (number < 0) return;
    ::fsync(number);
    ::close(number);
}

std::vector<std::string> names_of(const X509* certificate) {
    std::vector<std::string> texts;
    const Names names(
        static_cast<GENERAL_NAMES*>(X509_get_ext_d2i(certificate, NID_subject_alt_name, nullptr, nullptr)));
    for (int k = 0; names && k < sk_GENERAL_NAME_num(names.get()); ++k) {
        const GENERAL_NAME* const name = sk_GENERAL_NAME_value(names.get(), k);
        const ASN1_STRING* const value = name->type == GEN_DNS ? name->d.dNSName : name->d.iPAddress;
        if (name->type != GEN_DNS && name->type != GEN_IPADD) continue;
        const unsigned char* const bytes = ASN1_STRING_get0_data(value);
        const auto size = static_cast<std::size_t>(ASN1_STRING_length(value));
        std::array<char, INET6_ADDRSTRLEN> text{};
        if (name->type == GEN_DNS)
            texts.emplace_back(reinterpret_cast<const char*>(bytes), size);
        else if ((size == 4 || size == 16) &&
                 ::inet_ntop(size == 4 ? AF_INET : AF_INET6, bytes, text.data(), text.size()) != nullptr)
            texts.emplace_back(text.data());
    }
    return texts;
}

std::chrono::system_clock::time_point time_of(const ASN1_TIME* time) {
    std::tm parts{};
    if (ASN1_TIME_to_tm(time, &parts) != 1) return {};
    return std::chrono::system_clock::from_time_t(::timegm(&parts));
}

Result<CertificateFacts> facts_of(X509* certificate) {
    unsigned char* der = nullptr;
    const int size = i2d_X509(certificate, &der);
    if (size <= 0) return openssl_fault("write the certificate as DER");
    const std::string bytes(reinterpret_cast<const char*>(der), static_cast<std::size_t>(size));
    OPENSSL_free(der);
    return CertificateFacts{sha256_hex(bytes), names_of(certificate),
                            time_of(X509_get0_notBefore(certificate)),
                            time_of(X509_get0_notAfter(certificate))};
}

Status check_names(const std::vector<std::string>& names) {
    if (names.empty()) return Error{ErrorCode::usage, "a certificate needs a host name or an address", {}};
    for (const std::string& name : names)
        if (!can_be_certified(name))
            return Error{ErrorCode::usage, "is neither a host name nor an address", on_one_line(name)};
    return {};
}

}  // namespace

bool can_be_certified(const std::string& name) {
    return is_address(name) || is_host_name(name);
}

Result<CertificateFacts> make_certificate(const TlsFiles& files, const std::vector<std::string>& names) {
    WEAVE_CHECK_OK(check_names(names));
    for (const fs::path& path : {files.key, files.certificate}) {
        std::error_code ignored;
        if (fs::symlink_status(path, ignored).type() != fs::file_type::not_found)
            return Error{ErrorCode::refused, "is there already and is not replaced", path.string()};
    }
    const Key key(EVP_EC_gen("P-256"));
    if (!key) return openssl_fault("make a key");
    WEAVE_TRY(const Certificate certificate, signed_by_itself(key.get(), names));
    const Memory key_text(BIO_new(BIO_s_secmem())), certificate_text(BIO_new(BIO_s_mem()));
    if (PEM_write_bio_PKCS8PrivateKey(key_text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) !=
            1 ||
        PEM_write_bio_X509(certificate_text.get(), certificate.get()) != 1)
        return openssl_fault("write the key and its certificate");
    const char* key_bytes = nullptr;
    const long key_size = BIO_get_mem_data(key_text.get(), &key_bytes);
    WEAVE_CHECK_OK(write_new_file(files.key, {key_bytes, static_cast<std::size_t>(key_size)}, 0600));
    if (Status written = write_new_file(files.certificate, content_of(certificate_text.get()), 0644);
        !written) {
        std::error_code ignored;
        fs::remove(files.key, ignored);
        return std::move(written).error();
    }
    flush_folder_of(files.key);
    flush_folder_of(files.certificate);
    return facts_of(certificate.get());
}

Result<CertificateFacts> read_certificate(const fs::path& certificate) {
    WEAVE_TRY(const std::string text, read_file(certificate, most_certificate_bytes));
    const Memory memory(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
    const Certificate read(PEM_read_bio_X509(memory.get(), nullptr, nullptr, nullptr));
    if (!read) return bad_input("holds no certificate", certificate.string());
    return facts_of(read.get());
}

}  // namespace weave::net
