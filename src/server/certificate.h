// SPDX-License-Identifier: MIT
#pragma once

#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "foundation/result.h"

namespace embody::server {

/// PEM files of a certificate and its private key.
struct CertificateFiles {
    std::filesystem::path certificate, key;
};

/// The certificate that Embody signs itself, in `folder` (made where missing): for these names and IP addresses, valid
/// for 397 days, with an elliptic key (P-256) that only this user may read. Made anew where it ran out, does not name
/// all of them, or cannot be used; else it stays, so that a browser that accepted it once does so again.
Result<CertificateFiles> own_certificate(const std::filesystem::path& folder, const std::vector<std::string>& names,
                                         std::time_t now);

/// Why these files cannot serve now: unreadable, a key of another certificate, not valid yet or any more.
Result<void> check_certificate(const CertificateFiles& files, std::time_t now);

/// SHA-256 of the certificate as browsers show it: "AB:01:…".
Result<std::string> fingerprint(const std::filesystem::path& certificate);

}  // namespace embody::server
