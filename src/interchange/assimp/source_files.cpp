// SPDX-License-Identifier: MIT
#include "interchange/assimp/source_files.h"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <cstring>

namespace embody::interchange {
namespace {

/// A file held in memory.
class MemoryStream final : public Assimp::IOStream {
public:
    explicit MemoryStream(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}

    size_t Read(void* out, size_t size, size_t count) override {
        const size_t whole = size == 0 ? 0 : std::min(count, (bytes_.size() - at_) / size);
        if (whole == 0) return 0;
        std::memcpy(out, bytes_.data() + at_, whole * size);
        at_ += whole * size;
        return whole;
    }
    size_t Write(const void*, size_t, size_t) override { return 0; }
    aiReturn Seek(size_t offset, aiOrigin origin) override {
        const size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
        const size_t place = base + offset;
        if (place > bytes_.size()) return aiReturn_FAILURE;
        at_ = place;
        return aiReturn_SUCCESS;
    }
    size_t Tell() const override { return at_; }
    size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

private:
    std::vector<std::uint8_t> bytes_;
    size_t at_ = 0;
};

/// assimp 5.2 skips numbers such as ".5" in OBJ files, and with them the whole vertex: this writes "0.5" on v, vt and
/// vn lines.
std::vector<std::uint8_t> with_leading_zeros(const std::vector<std::uint8_t>& obj) {
    std::vector<std::uint8_t> out;
    out.reserve(obj.size() + obj.size() / 64);
    bool coordinates = false;
    std::uint8_t before = '\n';
    for (const std::uint8_t c : obj) {
        if (before == '\n' || before == '\r') coordinates = c == 'v';
        if (coordinates && c == '.' && (before == ' ' || before == '\t' || before == '-' || before == '+'))
            out.push_back('0');
        out.push_back(c);
        before = c;
    }
    return out;
}

class SourceFiles final : public Assimp::IOSystem {
public:
    explicit SourceFiles(const FileSource& source) : source_(&source) {}
    bool Exists(const char* path) const override { return !source_->find(path).empty(); }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char* mode) override {
        if (std::strpbrk(mode, "wa+") != nullptr || source_->find(path).empty()) return nullptr;
        auto bytes = source_->read(path);
        if (!bytes) return nullptr;
        const std::string extension = std::filesystem::path(path).extension().string();
        const bool obj = extension == ".obj" || extension == ".OBJ";
        return new MemoryStream(obj ? with_leading_zeros(*bytes) : std::move(*bytes));
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

private:
    const FileSource* source_;
};

}  // namespace

Assimp::IOSystem* new_source_files(const FileSource& source) { return new SourceFiles(source); }

}  // namespace embody::interchange
