// SPDX-License-Identifier: MIT
#include "server/certificate.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>

#include "foundation/printable.h"

namespace embody::server {
namespace {

namespace fs = std::filesystem;

/// The longest that browsers accept of a server's certificate.
constexpr long valid_days = 397;
/// So much earlier the next one is made, so that none runs out while it is used.
constexpr long renewal_days = 7;
constexpr long day = 24 * 60 * 60;  // s
/// A certificate is valid from some time before it was made, for headsets whose clock is late, s.
constexpr long earlier = 60 * 60;

template <auto free>
struct Free {
    template <class T>
    void operator()(T* freed) const {
        free(freed);
    }
};
void free_names(GENERAL_NAMES* names) { GENERAL_NAMES_free(names); }
using X509Pointer = std::unique_ptr<X509, Free<X509_free>>;
using KeyPointer = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using BioPointer = std::unique_ptr<BIO, Free<BIO_free_all>>;
using NamesPointer = std::unique_ptr<GENERAL_NAMES, Free<free_names>>;

/// What OpenSSL complained of last; it forgets that.
std::string openssl_reason() {
    std::array<char, 256> text{};
    const unsigned long code = ERR_peek_last_error();
    ERR_clear_error();
    if (code == 0) return "unknown reason";
    ERR_error_string_n(code, text.data(), text.size());
    return printable(text.data());
}

/// A person is never asked for the password of a key.
int no_password(char*, int, int, void*) { return -1; }

Result<BioPointer> open_pem(const fs::path& file, const char* option) {
    BioPointer bio(BIO_new_file(file.c_str(), "r"));
    ERR_clear_error();
    if (bio) return bio;
    return Error{file.string(), std::string("cannot be read: ") + std::strerror(errno),
                 std::string("name a PEM file that this user may read with ") + option};
}

Result<X509Pointer> read_certificate(const fs::path& file) {
    auto bio = open_pem(file, "--certificate");
    if (!bio) return bio.error();
    X509Pointer certificate(PEM_read_bio_X509(bio->get(), nullptr, no_password, nullptr));
    if (certificate) return certificate;
    return Error{file.string(), "holds no certificate in PEM form (" + openssl_reason() + ")",
                 "it begins with -----BEGIN CERTIFICATE-----"};
}

Result<KeyPointer> read_key(const fs::path& file) {
    auto bio = open_pem(file, "--key");
    if (!bio) return bio.error();
    KeyPointer key(PEM_read_bio_PrivateKey(bio->get(), nullptr, no_password, nullptr));
    if (key) return key;
    return Error{file.string(), "holds no private key in PEM form without a password (" + openssl_reason() + ")",
                 "it begins with -----BEGIN PRIVATE KEY-----"};
}

std::string text_of(const ASN1_TIME* time) {
    std::tm utc{};
    if (ASN1_TIME_to_tm(time, &utc) != 1) return "?";
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%d", &utc);
    return text.data();
}

/// Names and addresses that the certificate is for.
std::vector<std::string> names_of(const X509& certificate) {
    std::vector<std::string> names;
    const NamesPointer all(
        static_cast<GENERAL_NAMES*>(X509_get_ext_d2i(&certificate, NID_subject_alt_name, nullptr, nullptr)));
    for (int i = 0; all && i < sk_GENERAL_NAME_num(all.get()); ++i) {
        const GENERAL_NAME* name = sk_GENERAL_NAME_value(all.get(), i);
        const ASN1_STRING* text = name->type == GEN_IPADD ? name->d.iPAddress : name->d.dNSName;
        const unsigned char* bytes = ASN1_STRING_get0_data(text);
        const auto size = static_cast<std::size_t>(ASN1_STRING_length(text));
        if (name->type == GEN_DNS) names.emplace_back(reinterpret_cast<const char*>(bytes), size);
        if (name->type != GEN_IPADD || (size != 4 && size != 16)) continue;
        std::array<char, INET6_ADDRSTRLEN> address{};
        if (inet_ntop(size == 4 ? AF_INET : AF_INET6, bytes, address.data(), address.size()) != nullptr)
            names.emplace_back(address.data());
    }
    return names;
}

bool is_address(const std::string& name) {
    std::array<unsigned char, 16> bytes{};
    return inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 || inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

bool add_extension(X509* certificate, int what, const std::string& value) {
    X509V3_CTX context;
    X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
    X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, what, value.c_str());
    const bool added = extension != nullptr && X509_add_ext(certificate, extension, -1) == 1;
    X509_EXTENSION_free(extension);
    return added;
}

bool set_serial(X509* certificate) {
    std::array<unsigned char, 16> bytes{};
    if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) return false;
    bytes[0] = static_cast<unsigned char>((bytes[0] & 0x7F) | 0x40);  // positive, and never shorter
    BIGNUM* number = BN_bin2bn(bytes.data(), static_cast<int>(bytes.size()), nullptr);
    const bool set = number != nullptr && BN_to_ASN1_INTEGER(number, X509_get_serialNumber(certificate)) != nullptr;
    BN_free(number);
    return set;
}

X509Pointer make_certificate(EVP_PKEY* key, const std::vector<std::string>& names, std::time_t now) {
    X509Pointer certificate(X509_new());
    X509* made = certificate.get();
    if (!made || X509_set_version(made, 2) != 1 || !set_serial(made)) return nullptr;
    ASN1_TIME_adj(X509_getm_notBefore(made), now, 0, -earlier);
    ASN1_TIME_adj(X509_getm_notAfter(made), now, 0, valid_days * day - earlier);
    X509_NAME* subject = X509_get_subject_name(made);
    const auto* title = reinterpret_cast<const unsigned char*>("Embody Studio");
    X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_UTF8, title, -1, -1, 0);
    X509_set_issuer_name(made, subject);
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : ",") + std::string(is_address(name) ? "IP:" : "DNS:") + name;
    const bool extended = X509_set_pubkey(made, key) == 1 && add_extension(made, NID_subject_alt_name, all) &&
                          add_extension(made, NID_basic_constraints, "critical,CA:FALSE") &&
                          add_extension(made, NID_key_usage, "critical,digitalSignature") &&
                          add_extension(made, NID_ext_key_usage, "serverAuth");
    if (!extended || X509_sign(made, key, EVP_sha256()) == 0) return nullptr;
    return certificate;
}

/// Writes with the mode from the first byte on: nobody else may open a key in between.
Result<void> write_pem(const fs::path& file, mode_t mode, const auto& write) {
    const fs::path draft = file.string() + ".new";
    std::error_code ignored;
    fs::remove(draft, ignored);
    const int descriptor = open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    std::FILE* stream = descriptor >= 0 ? fdopen(descriptor, "w") : nullptr;
    if (stream == nullptr) return Error{file.string(), std::string("cannot be written: ") + std::strerror(errno), ""};
    const bool written = write(stream) == 1;
    if (std::fclose(stream) != 0 || !written) return Error{file.string(), "cannot be written", "is the disk full?"};
    fs::rename(draft, file, ignored);
    return ignored ? Result<void>(Error{file.string(), "cannot be written: " + ignored.message(), ""}) : Result<void>{};
}

bool is_for_all(const CertificateFiles& files, const std::vector<std::string>& names, std::time_t now) {
    if (!check_certificate(files, now) || !check_certificate(files, now + renewal_days * day)) return false;
    const auto certificate = read_certificate(files.certificate);
    if (!certificate) return false;
    const std::vector<std::string> known = names_of(**certificate);
    return std::ranges::all_of(names,
                               [&](const std::string& name) { return std::ranges::find(known, name) != known.end(); });
}

}  // namespace

Result<CertificateFiles> own_certificate(const fs::path& folder, const std::vector<std::string>& names,
                                         std::time_t now) {
    const CertificateFiles files{folder / "certificate.pem", folder / "key.pem"};
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return Error{folder.string(), "cannot be made: " + error.message(), ""};
    if (is_for_all(files, names, now)) return files;
    const KeyPointer key(EVP_EC_gen("P-256"));
    const X509Pointer certificate = key ? make_certificate(key.get(), names, now) : nullptr;
    if (!certificate) return Error{"certificate", "cannot be made: " + openssl_reason(), ""};
    const auto write_key = [&](std::FILE* stream) {
        return PEM_write_PrivateKey(stream, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
    };
    const auto write_certificate = [&](std::FILE* stream) { return PEM_write_X509(stream, certificate.get()); };
    if (auto written = write_pem(files.key, 0600, write_key); !written) return written.error();
    if (auto written = write_pem(files.certificate, 0644, write_certificate); !written) return written.error();
    return files;
}

Result<void> check_certificate(const CertificateFiles& files, std::time_t now) {
    const auto certificate = read_certificate(files.certificate);
    if (!certificate) return certificate.error();
    const auto key = read_key(files.key);
    if (!key) return key.error();
    const std::string file = files.certificate.string();
    if (X509_check_private_key(certificate->get(), key->get()) != 1) {
        ERR_clear_error();
        return Error{files.key.string(), "is not the key of " + file, "name the two files that were made together"};
    }
    const ASN1_TIME* first = X509_get0_notBefore(certificate->get());
    const ASN1_TIME* last = X509_get0_notAfter(certificate->get());
    if (X509_cmp_time(first, &now) > 0)
        return Error{file, "is valid only from " + text_of(first), "is the clock of this machine right?"};
    if (X509_cmp_time(last, &now) < 0) return Error{file, "expired on " + text_of(last), "get a new one"};
    return {};
}

Result<std::string> fingerprint(const fs::path& certificate) {
    const auto read = read_certificate(certificate);
    if (!read) return read.error();
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (X509_digest(read->get(), EVP_sha256(), digest.data(), &size) != 1)
        return Error{certificate.string(), openssl_reason(), ""};
    std::string text;
    for (const unsigned byte : std::span(digest.data(), size)) {
        if (!text.empty()) text += ':';
        text += "0123456789ABCDEF"[byte >> 4];
        text += "0123456789ABCDEF"[byte & 15];
    }
    return text;
}

}  // namespace embody::server
