#pragma once

#include <weave/core/file.hpp>

#include <catch2/catch.hpp>

#include <filesystem>
#include <memory>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <string>

namespace weave::loomlink::testing {

/// An authority such as a mill's own: signs certificates of servers, and is known by a certificate itself.
class TestAuthority {
  public:
    TestAuthority() {
        make_certificate(m_certificate.get(), "the mill's authority", m_key.get());
        add(m_certificate.get(), NID_basic_constraints, "critical,CA:TRUE");
        add(m_certificate.get(), NID_key_usage, "critical,keyCertSign");
        REQUIRE(X509_sign(m_certificate.get(), m_key.get(), EVP_sha256()) > 0);
    }

    /// Its own certificate, for those who are to trust it.
    void write(const std::filesystem::path& file) const {
        write_pem(file, [&](BIO* out) { return PEM_write_bio_X509(out, m_certificate.get()); });
    }

    /// A certificate for these names, as OpenSSL writes them (`DNS:mill,IP:127.0.0.1`), and its key.
    void certify(const char* names, const std::filesystem::path& file,
                 const std::filesystem::path& key_file) const {
        const Key key = new_key();
        const Certificate certificate{X509_new(), X509_free};
        make_certificate(certificate.get(), "a server", key.get());
        add(certificate.get(), NID_subject_alt_name, names);
        REQUIRE(X509_sign(certificate.get(), m_key.get(), EVP_sha256()) > 0);
        write_pem(file, [&](BIO* out) { return PEM_write_bio_X509(out, certificate.get()); });
        write_pem(key_file, [&](BIO* out) {
            return PEM_write_bio_PrivateKey(out, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
        });
    }

  private:
    using Key = std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)>;
    using Certificate = std::unique_ptr<X509, void (*)(X509*)>;

    static Key new_key() { return {EVP_EC_gen("P-256"), EVP_PKEY_free}; }

    void make_certificate(X509* certificate, const char* subject, EVP_PKEY* key) const {
        constexpr long day = 24 * 60 * 60;
        static long serial = 0;
        const auto name = [](X509_NAME* place, const char* text) {
            return X509_NAME_add_entry_by_txt(place, "CN", MBSTRING_UTF8,
                                              reinterpret_cast<const unsigned char*>(text), -1, -1, 0);
        };
        REQUIRE(X509_set_version(certificate, X509_VERSION_3) == 1);
        REQUIRE(ASN1_INTEGER_set(X509_get_serialNumber(certificate), ++serial) == 1);
        REQUIRE(X509_gmtime_adj(X509_getm_notBefore(certificate), -day) != nullptr);
        REQUIRE(X509_gmtime_adj(X509_getm_notAfter(certificate), day) != nullptr);
        REQUIRE(name(X509_get_subject_name(certificate), subject) == 1);
        REQUIRE(name(X509_get_issuer_name(certificate), "the mill's authority") == 1);
        REQUIRE(X509_set_pubkey(certificate, key) == 1);
    }
    static void add(X509* certificate, int what, const char* value) {
        X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, nullptr, what, value);
        REQUIRE(X509_add_ext(certificate, extension, -1) == 1);
        X509_EXTENSION_free(extension);
    }
    template <class Write>
    static void write_pem(const std::filesystem::path& file, Write write) {
        const std::unique_ptr<BIO, int (*)(BIO*)> memory{BIO_new(BIO_s_mem()), BIO_free};
        REQUIRE(write(memory.get()) == 1);
        char* bytes = nullptr;
        const long size = BIO_get_mem_data(memory.get(), &bytes);
        REQUIRE(write_file(file, {bytes, static_cast<std::size_t>(size)}));
    }

    Key m_key = new_key();
    Certificate m_certificate{X509_new(), X509_free};
};

}  // namespace weave::loomlink::testing
