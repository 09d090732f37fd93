// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "source/image/open_image.hpp"
#include "support/png_bytes.hpp"
#include "support/source_files.hpp"

// PNG pictures: every kind of pixel, and files that lie.

#if MC_WITH_PNG

namespace mc::test {
namespace {

using source::channel_named;
using source::ImageFile;

/// A channel's bytes, the bottom row first where `up`.
std::string pixels(const ImageFile& image, std::size_t channel, bool up = false) {
  const source::ImagePart& part = image.parts().front();
  const auto row = static_cast<std::ptrdiff_t>(part.width) *
                   std::ptrdiff_t(sample_size(part.channels[channel].type));
  std::string out(static_cast<std::size_t>(row * part.height), '?');
  auto* first = reinterpret_cast<std::byte*>(out.data());
  image.read(0, channel, up ? first + (part.height - 1) * row : first, up ? -row : row);
  return out;
}

struct Opened {
  Folder folder;
  source::MappedFile file;
  std::unique_ptr<ImageFile> image;

  explicit Opened(const std::string& bytes)
      : file(folder.file("a.png", bytes)), image(open_image(source::ImageKind::png, file)) {}
};

std::string error_of_png(const std::string& bytes) {
  const Folder folder;
  const std::string path = folder.file("a.png", bytes);
  const std::string error = error_of([&] {
    const source::MappedFile file(path);
    const auto image = open_image(source::ImageKind::png, file);
    pixels(*image, 0);
  });
  const std::size_t at = error.find(path);
  return at == std::string::npos ? error : error.substr(0, at) + error.substr(at + path.size() - 5);
}

TEST(Png, GreysOfEightAndSixteenBits) {
  const Opened eight(png_bytes(3, 2, 8, PngColour::grey, "abcdef"));
  const source::ImagePart& part = eight.image->parts().front();
  EXPECT_EQ(part.width, 3);
  EXPECT_EQ(part.height, 2);
  EXPECT_EQ(channel_list(part), "Y");
  EXPECT_EQ(part.channels[0].type, SampleType::u8);
  EXPECT_EQ(pixels(*eight.image, 0), "abcdef");
  EXPECT_EQ(pixels(*eight.image, 0, true), "defabc");

  const Opened sixteen(png_bytes(2, 1, 16, PngColour::grey, {"\x12\x34\xff\x00", 4}));
  EXPECT_EQ(sixteen.image->parts().front().channels[0].type, SampleType::u16);
  const std::string native = pixels(*sixteen.image, 0);
  std::array<std::uint16_t, 2> values{};
  std::memcpy(values.data(), native.data(), 4);
  EXPECT_EQ(values, (std::array<std::uint16_t, 2>{0x1234, 0xff00}));
}

TEST(Png, FewBitsAreWidened) {
  const Opened bits(png_bytes(8, 1, 1, PngColour::grey, "\xa5"));
  EXPECT_EQ(pixels(*bits.image, 0), (std::string{"\xff\0\xff\0\0\xff\0\xff", 8}));
}

TEST(Png, ColoursAndPalettesHaveChannels) {
  const Opened rgba(png_bytes(2, 1, 8, PngColour::rgba, "RGBArgba"));
  EXPECT_EQ(channel_list(rgba.image->parts().front()), "R, G, B, A");
  EXPECT_EQ(pixels(*rgba.image, 2), "Bb");
  const Opened grey(png_bytes(2, 1, 8, PngColour::grey_alpha, "YAya"));
  EXPECT_EQ(channel_list(grey.image->parts().front()), "Y, A");
  EXPECT_EQ(pixels(*grey.image, 1), "Aa");
  const Opened palette(png_bytes(2, 1, 8, PngColour::palette, {"\1\0", 2}, "RGBrgb"));
  EXPECT_EQ(channel_list(palette.image->parts().front()), "R, G, B");
  EXPECT_EQ(pixels(*palette.image, 1), "gG");
}

TEST(Png, ChannelsAreChosenByName) {
  const Opened rgba(png_bytes(1, 1, 8, PngColour::rgba, "RGBA"));
  const source::ImagePart& part = rgba.image->parts().front();
  EXPECT_EQ(channel_named(part, "B"), 2U);
  EXPECT_EQ(channel_named(part, "Y"), std::nullopt);
  EXPECT_EQ(channel_named(part, std::nullopt), 0U);
  source::ImagePart other;
  other.channels = {{"A", SampleType::u8}, {"R", SampleType::u8}, {"Y", SampleType::u8}};
  EXPECT_EQ(channel_named(other, std::nullopt), 2U);
  other.channels = {{"A", SampleType::u8}, {"B", SampleType::u8}};
  EXPECT_EQ(channel_named(other, std::nullopt), 0U);
}

TEST(Png, DamageIsNamed) {
  const std::string good = png_bytes(3, 2, 8, PngColour::grey, "abcdef");
  EXPECT_EQ(error_of_png(good.substr(0, good.size() - 30)),
            "3 a.png: damaged PNG: the file ends too soon");
  std::string flipped = good;
  flipped[good.size() - 25] ^= 1;
  EXPECT_EQ(error_of_png(flipped).substr(0, 22), "3 a.png: damaged PNG: ");
  EXPECT_EQ(error_of_png("\x89PNG\r\n\x1a\n").substr(0, 22), "3 a.png: damaged PNG: ");
}

TEST(Png, SizesAreHeldAgainstTheFile) {
  const std::string header =
      big_endian(0x7FFFFFFF) + big_endian(0x7FFFFFFF) + std::string("\x10\x06\0\0\0", 5);
  const std::string bytes = "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) +
                            png_chunk("IDAT", stored("x")) + png_chunk("IEND", "");
  EXPECT_EQ(error_of_png(bytes),
            "3 a.png: damaged PNG: 69 bytes cannot hold 2147483647x2147483647 pixels");
}

}  // namespace
}  // namespace mc::test

#endif
