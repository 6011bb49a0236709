// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "catalog/prepare/thumbnail.h"
#include "interchange/image/image_codec.h"

namespace embody::catalog {

std::vector<std::uint8_t> thumbnail_of_icon(const interchange::FileSource& source, const std::string& path) {
    const auto bytes = source.read(path);
    if (!bytes) return {};
    const auto icon = interchange::decode_image(*bytes);
    if (!icon) return {};

    // The longer side fills the thumbnail.
    const double ratio = static_cast<double>(thumbnail_size) / std::max(icon->width, icon->height);
    const auto fitted = interchange::resized(*icon, std::max(1, static_cast<int>(icon->width * ratio)),
                                             std::max(1, static_cast<int>(icon->height * ratio)));
    interchange::Image padded{thumbnail_size, thumbnail_size, {}};
    padded.rgba.resize(std::size_t{4} * thumbnail_size * thumbnail_size);
    const int left = (thumbnail_size - fitted.width) / 2, top = (thumbnail_size - fitted.height) / 2;
    for (int row = 0; row < fitted.height; ++row) {
        std::memcpy(&padded.rgba[4 * static_cast<std::size_t>((top + row) * thumbnail_size + left)],
                    &fitted.rgba[4 * static_cast<std::size_t>(row * fitted.width)],
                    4 * static_cast<std::size_t>(fitted.width));
    }
    return interchange::encode_png(padded);
}

}  // namespace embody::catalog
