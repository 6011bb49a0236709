// SPDX-License-Identifier: MIT
// The attacks on other formats, as VRML: confined like them, and refused with the file's name.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "catalog/prepare/confined_pool.h"
#include "folders.h"
#include "interchange/read_model.h"
#include "interchange/scratch_files.h"

namespace embody::catalog {
namespace {

using test::ScratchFolder;

const std::filesystem::path real_worker = build_folder() / "src/embody-import-worker";
const std::string box = "Shape { geometry Box { size 1 1 1 } }\n";

std::string vrml(const std::string& body) { return "#VRML V2.0 utf8\n" + body + box; }

class VrmlAttacks : public testing::Test {
protected:
    void SetUp() override {
        if (!interchange::can_read("model.wrl")) GTEST_SKIP() << "this build reads no VRML";
    }

    /// The result of each file, in order.
    std::vector<Result<PreparedModel>> prepare(const std::vector<std::filesystem::path>& files) const {
        std::vector<ImportItem> items;
        for (const auto& file : files) items.push_back({.path = file.string()});
        std::vector<Result<PreparedModel>> results(files.size(), Error{"", "was not told"});
        const auto run = prepare_confined(items,
                                          {.workers = 1,
                                           .processor_seconds_per_model = 5,
                                           .wall_seconds_per_model = 200,
                                           .bytes = std::size_t{3} << 30,
                                           .worker_program = real_worker},
                                          [&](std::size_t item, Result<PreparedModel> prepared) {
                                              results[item] = std::move(prepared);
                                              return true;
                                          });
        EXPECT_TRUE(run) << run.error().message();
        return results;
    }

    ScratchFolder scratch_;
};

TEST_F(VrmlAttacks, BombsEndTheirOwnFileOnly) {
    // Prototypes of two of each other, thirty levels deep; a picture and a grid larger than any memory; nodes that
    // contain themselves.
    std::string prototypes = "PROTO P0 [] { Group { children [ " + box + "] } }\n";
    for (int i = 1; i < 30; ++i) {
        const std::string below = "P" + std::to_string(i - 1) + " {} ";
        prototypes += "PROTO P" + std::to_string(i) + " [] { Group { children [ " + below + below + "] } }\n";
    }
    const std::string picture =
        "Shape { appearance Appearance { texture PixelTexture { image 2000000000 2000000000 4 0 } } geometry Box {} "
        "}\n";
    const std::string grid = "Shape { geometry ElevationGrid { xDimension 99999 zDimension 99999 height [0] } }\n";
    const auto results =
        prepare({scratch_.write("a.wrl", vrml(prototypes + "P29 {}\n")), scratch_.write("b.wrl", vrml(picture)),
                 scratch_.write("c.wrl", vrml(grid)), scratch_.write("d.wrl", vrml("DEF A Group { children USE A }\n")),
                 scratch_.write("good.wrl", vrml(""))});
    for (std::size_t i = 0; i < 4; ++i) {
        if (results[i]) continue;
        EXPECT_NE(results[i].error().where.find(std::string(1, static_cast<char>('a' + i)) + ".wrl"),
                  std::string::npos);
        EXPECT_FALSE(results[i].error().why.empty());
    }
    EXPECT_FALSE(results[0]);
    EXPECT_FALSE(results[2]);
    EXPECT_TRUE(results[4]) << results[4].error().message();
}

TEST_F(VrmlAttacks, NoNodeOpensOtherFiles) {
    // A pipe without a writer: opening it waits without end. It lies where the worker may read.
    std::filesystem::create_directory(scratch_.path() / "models");
    const std::string pipe = (scratch_.path() / "models/pipe.png").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::vector<std::filesystem::path> files;
    for (const std::string node :
         {"Texture2 { filename", "Texture3 { filenames", "TextureCubeMap { filenamePosX", "BumpMap { filename",
          "Image { filename", "File { name", "WWWInline { name", "Inline { url", "ImageTexture { url",
          "MovieTexture { url", "AudioClip { url", "Background { frontUrl", "VertexShader { sourceProgram"}) {
        files.push_back(
            scratch_.write("models/" + node.substr(0, node.find(' ')) + ".wrl", vrml(node + " \"" + pipe + "\" }\n")));
    }
    for (const auto& result : prepare(files)) {
        // The pipe is left out or not understood; the worker never waits for it.
        if (!result) {
            EXPECT_EQ(result.error().why.find("was not ready"), std::string::npos) << result.error().message();
        }
    }
}

TEST_F(VrmlAttacks, SizesAndLinksAreThoseOfOtherFormats) {
    const auto sparse = scratch_.write("sparse.wrl", vrml(""));
    std::filesystem::resize_file(sparse, std::uintmax_t{1} << 30);
    scratch_.write("secret.wrl", vrml(""));
    std::filesystem::create_directory(scratch_.path() / "models");
    const auto link = scratch_.path() / "models/link.wrl";
    std::filesystem::create_symlink("../secret.wrl", link);
    const auto results = prepare({sparse, link});
    ASSERT_FALSE(results[0]);
    EXPECT_EQ(results[0].error().why, "is larger than the limit of 512 MiB");
    EXPECT_FALSE(results[1]);
}

}  // namespace
}  // namespace embody::catalog
