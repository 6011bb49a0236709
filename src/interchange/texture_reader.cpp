// SPDX-License-Identifier: MIT
#include "interchange/texture_reader.h"

#include "interchange/image/image_codec.h"

namespace embody::interchange {
namespace {

Result<std::vector<std::uint8_t>> png_or_jpeg(std::vector<std::uint8_t> bytes) {
    const auto header = read_image_header(bytes);
    if (!header) return header.error();
    if (header->format != ImageFormat::other) return bytes;
    const auto image = decode_image(bytes);
    if (!image) return image.error();
    return encode_png(*image);
}

}  // namespace

TextureReader::TextureReader(const FileSource& source, const std::string& model_path, RawScene& scene)
    : source_(source), scene_(scene) {
    const std::size_t slash = model_path.rfind('/');
    folder_ = slash == std::string::npos ? std::string() : model_path.substr(0, slash + 1);
}

int TextureReader::index_of(const std::string& reference) {
    const auto known = indices_.find(reference);
    return known != indices_.end() ? known->second : index_of(reference, read(reference));
}

int TextureReader::index_of(const std::string& reference, Result<std::vector<std::uint8_t>> bytes) {
    const auto [known, is_new] = indices_.try_emplace(reference, -1);
    if (!is_new) return known->second;
    if (bytes) bytes = png_or_jpeg(std::move(*bytes));
    if (!bytes) {
        scene_.warnings.push_back("texture \"" + reference + "\" left out: " + bytes.error().why);
        return -1;
    }
    known->second = static_cast<int>(scene_.images.size());
    scene_.images.push_back({reference, std::move(*bytes)});
    return known->second;
}

Result<std::vector<std::uint8_t>> TextureReader::read(const std::string& reference) const {
    // Beside the model, else by its bare name: exporters write the paths of their own machine. Else by its last word:
    // readers that know no spaces in names have taught authors to call "Living room rug.jpg" "rug.jpg".
    std::string found = source_.find(folder_ + reference);
    for (const char* const separators : {"/\\", "/\\ \t"}) {
        const std::size_t end = reference.find_last_of(separators);
        if (found.empty() && end != std::string::npos) found = source_.find(folder_ + reference.substr(end + 1));
    }
    if (found.empty()) return Error{reference, "is not in the model's folder"};
    return source_.read(found);
}

}  // namespace embody::interchange
