// SPDX-License-Identifier: MIT
#include "cli/qr_code.h"

#include <qrencode.h>

#include <memory>

namespace embody::cli {
namespace {

/// Light modules around the code that readers need: ISO/IEC 18004, 9.1.
constexpr int quiet_zone = 4;

struct FreeCode {
    void operator()(QRcode* code) const { QRcode_free(code); }
};

}  // namespace

std::string qr_code(const std::string& text, QrColors colors) {
    // 15 % may be lost: a terminal's picture is flawless, and a smaller code is read from further away.
    const std::unique_ptr<QRcode, FreeCode> code(QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_M));
    if (!code) return {};
    const auto is_light = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= code->width || y >= code->width) return true;
        return (code->data[y * code->width + x] & 1) == 0;
    };
    std::string drawn;
    for (int y = -quiet_zone; y < code->width + quiet_zone; y += 2) {
        // White on black, whatever the terminal's own colours are.
        if (colors == QrColors::dark_on_light) drawn += "\033[38;5;231;48;5;16m";
        for (int x = -quiet_zone; x < code->width + quiet_zone; ++x) {
            const bool upper = is_light(x, y), lower = is_light(x, y + 1);
            drawn += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
        }
        drawn += colors == QrColors::dark_on_light ? "\033[0m\n" : "\n";
    }
    return drawn;
}

}  // namespace embody::cli
