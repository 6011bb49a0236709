// SPDX-License-Identifier: MIT
#include "server/certificate.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <sstream>

#include "database/temporary_folder.h"

namespace embody::server {
namespace {

namespace fs = std::filesystem;
constexpr std::time_t day = 24 * 60 * 60, today = 1'800'000'000;

std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

class CertificateTest : public testing::Test {
protected:
    CertificateFiles make(const std::vector<std::string>& names, std::time_t now = today) const {
        const auto made = own_certificate(folder_ / "tls", names, now);
        EXPECT_TRUE(made) << made.error().message();
        return made ? *made : CertificateFiles{};
    }
    static std::string refusal(const CertificateFiles& files, std::time_t now = today) {
        const auto checked = check_certificate(files, now);
        return checked ? "" : checked.error().message();
    }
    test::TemporaryFolder folder_;
};

TEST_F(CertificateTest, IsKeptWhileItServes) {
    const auto files = make({"localhost", "192.168.1.5", "fd00::5"});
    EXPECT_EQ(refusal(files), "");
    struct stat key {};
    ASSERT_EQ(stat(files.key.c_str(), &key), 0);
    EXPECT_EQ(key.st_mode & 0777, 0600u);
    const std::string first = text_of(files.certificate);
    // The same names, fewer, and in another order.
    make({"localhost", "192.168.1.5", "fd00::5"}, today + 300 * day);
    make({"fd00::5", "localhost"});
    EXPECT_EQ(text_of(files.certificate), first);
    const auto print = fingerprint(files.certificate);
    ASSERT_TRUE(print);
    EXPECT_EQ(print->size(), 95u);
}

TEST_F(CertificateTest, IsMadeAnewWhereItServesNoMore) {
    const auto files = make({"localhost", "192.168.1.5"});
    std::string before = text_of(files.certificate);
    const auto expect_new = [&](const char* why) {
        EXPECT_NE(text_of(files.certificate), before) << why;
        EXPECT_EQ(refusal(files, today + day), "") << why;
        before = text_of(files.certificate);
    };
    make({"localhost", "192.168.1.6"});
    expect_new("another address");
    make({"localhost", "192.168.1.6"}, today + 395 * day);
    EXPECT_NE(text_of(files.certificate), before) << "it would run out within a week";
    make({"localhost"}, today);
    expect_new("it is of the future");
    std::ofstream(files.key) << "rubbish";
    make({"localhost"});
    expect_new("the key is broken");
    fs::remove(files.certificate);
    make({"localhost"});
    EXPECT_EQ(refusal(files), "");
}

TEST_F(CertificateTest, RefusalsSayWhatIsWrong) {
    const auto files = make({"localhost"});
    const auto other = own_certificate(folder_ / "other", {"localhost"}, today);
    ASSERT_TRUE(other);
    EXPECT_NE(refusal({files.certificate, other->key}).find("is not the key of"), std::string::npos);
    EXPECT_NE(refusal(files, today + 400 * day).find("expired on 2028-02-1"), std::string::npos)
        << refusal(files, today + 400 * day);
    EXPECT_NE(refusal(files, today - 2 * day).find("is valid only from"), std::string::npos);
    EXPECT_NE(refusal({folder_ / "none.pem", files.key}).find("cannot be read: No such file"), std::string::npos);
    EXPECT_NE(refusal({files.key, files.key}).find("holds no certificate"), std::string::npos);
    EXPECT_NE(refusal({files.certificate, files.certificate}).find("holds no private key"), std::string::npos);
}

}  // namespace
}  // namespace embody::server
