// SPDX-License-Identifier: MIT
#include "interchange/assimp/source_files.h"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cstring>

namespace embody::interchange {
namespace {

/// A file held in memory.
class MemoryStream final : public Assimp::IOStream {
public:
    explicit MemoryStream(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}

    size_t Read(void* out, size_t size, size_t count) override {
        if (size == 0) return 0;
        const size_t whole = std::min(count, (bytes_.size() - at_) / size);
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

}  // namespace

Assimp::IOStream* SourceFiles::Open(const char* path, const char* mode) {
    if (std::strpbrk(mode, "wa+") != nullptr || source_->find(path).empty()) return nullptr;
    auto bytes = source_->read(path);
    return bytes ? new MemoryStream(std::move(*bytes)) : nullptr;
}

void SourceFiles::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace embody::interchange
