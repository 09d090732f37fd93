// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "base/parallel.hpp"
#include "support/memory_readers.hpp"
#include "support/random_edits.hpp"
#include "support/random_fields.hpp"
#include "support/reference_edits.hpp"

// Laws of edits, over random edits, fields, types, places, conventions and threads.

namespace mc::test {

namespace {

constexpr Index3 kDims{19, 13, 17};

/// Places of samples in the world: plain, stretched and mirrored, sheared, turned by a permutation.
const std::vector<Affine> kPlaces{Affine{}, Affine::scale_translate({0.5, -1.25, 2}, {-3, 4, 5}),
                                  Affine{{1, 0.3, 0, 2, 0.1, 1.2, -0.2, 0, 0, 0.25, 0.8, -1}},
                                  Affine{{0, 0, 1.5, 0, 1, 0, 0, 3, 0, -0.75, 0, 1}}};

Vec3 middle_of(const Affine& map, const Index3& dims) {
  return map({dims[0] / 2.0, dims[1] / 2.0, dims[2] / 2.0});
}

template <class T>
std::vector<T> read_all(const EditStore& store, const Index3& dims, const Index3& first = {}) {
  std::vector<T> out(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  const IndexBox box{first,
                     {first[0] + dims[0] - 1, first[1] + dims[1] - 1, first[2] + dims[2] - 1}};
  store.read_box(box, std::as_writable_bytes(std::span(out)));
  return out;
}

std::vector<std::uint16_t> materials_of_samples(const EditStore& store, const Index3& dims) {
  std::vector<Vec3> places;
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    for (std::int32_t j = 0; j < dims[1]; ++j) {
      for (std::int32_t i = 0; i < dims[0]; ++i) {
        places.push_back({double(i), double(j), double(k)});
      }
    }
  }
  std::vector<std::uint16_t> out(places.size());
  const VolumeReader reader = store.reader();
  if (const AttributeReader* materials =
          find_attribute(attributes_of(reader), material_attribute())) {
    EXPECT_EQ(materials->values_at(places, reinterpret_cast<std::byte*>(out.data())), 0U);
  }
  return out;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <class T>
std::size_t first_difference(const std::vector<T>& a, const std::vector<T>& b) {
  std::size_t n = 0;
  while (n < a.size() && std::memcmp(&a[n], &b[n], sizeof(T)) == 0) ++n;
  return n;
}

/// A field, its store and its reference.
template <class T>
struct Trial {
  Trial(std::uint64_t seed, bool above, const Affine& map)
      : samples(random_field<T>(kDims, Noise(seed % 4), seed)),
        rules{above, test_iso<T>(), map},
        input(std::make_unique<MemorySlabs>(samples, kDims, layout(seed, map))),
        reference(samples, kDims, rules),
        edits(seed, {middle_of(map, kDims), 9, 5, std::is_integral_v<T> ? 6.0 : 0.5}) {}

  static MemorySlabs::Layout layout(std::uint64_t seed, const Affine& map) {
    return {.to_world = map,
            .endian = seed % 3 == 0 ? std::endian::big : std::endian::little,
            .row_padding = seed % 5,
            .lead = seed % 2};
  }

  std::vector<T> samples;
  EditRules rules;
  VolumeReader input;
  ReferenceVolume<T> reference;
  RandomEdits edits;
};

template <class T>
class EditLaws : public testing::Test {};
using Types = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                             std::int32_t, std::int64_t, Half, float, double>;
TYPED_TEST_SUITE(EditLaws, Types);

TYPED_TEST(EditLaws, BitsAreTheReferences) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Trial<TypeParam> trial(seed, seed % 2 == 0, kPlaces[seed % kPlaces.size()]);
    EditStore store(trial.input, trial.rules);
    for (int n = 0; n < 10; ++n) {
      const Edit edit = trial.edits.next();
      const std::vector<TypeParam> before = trial.reference.samples;
      trial.reference.apply(edit);
      const EditEffect planned = store.measure(edit);
      const base::ThreadLimit threads(std::array{1, 2, 7}[static_cast<std::size_t>(n) % 3]);
      const EditEffect effect = store.apply(edit);
      const auto got = read_all<TypeParam>(store, kDims);
      ASSERT_TRUE(same_bits(got, trial.reference.samples))
          << "seed " << seed << ", edit " << n << ", op " << static_cast<int>(edit.op) << ", shape "
          << static_cast<int>(edit.shape.type) << ", sample "
          << first_difference(got, trial.reference.samples);
      ASSERT_EQ(effect.n_samples, trial.reference.reached.size()) << seed << " " << n;
      if (edit.op != EditOp::flatten) {
        ASSERT_EQ(planned.n_samples, effect.n_samples);
      }
      for (std::size_t at = 0; at < got.size(); ++at) {
        if (std::memcmp(&got[at], &before[at], sizeof(TypeParam)) == 0) continue;
        const auto i = static_cast<std::int32_t>(at);
        ASSERT_TRUE(effect.touched.contains(
            Index3{i % kDims[0], i / kDims[0] % kDims[1], i / kDims[0] / kDims[1]}));
      }
      if (edit.op == EditOp::paint) {
        ASSERT_EQ(materials_of_samples(store, kDims), trial.reference.materials);
      }
    }
  }
}

TYPED_TEST(EditLaws, UndoAndRedoRestoreEveryBit) {
  Trial<TypeParam> trial(11, true, kPlaces[2]);
  EditStore store(trial.input, trial.rules);
  std::vector<std::vector<TypeParam>> states{read_all<TypeParam>(store, kDims)};
  std::vector<std::uint64_t> hashes{store.hash()};
  for (int n = 0; n < 12; ++n) {
    const bool grouped = n % 4 == 3;
    if (grouped) store.begin_group();
    store.apply(n % 5 == 4 ? Edit{.op = EditOp::fill, .value = 1.0 * n} : trial.edits.next());
    if (grouped) store.apply(trial.edits.next());
    if (grouped) store.end_group();
    states.push_back(read_all<TypeParam>(store, kDims));
    hashes.push_back(store.hash());
  }
  const auto expect_state = [&](std::size_t n) {
    ASSERT_TRUE(same_bits(read_all<TypeParam>(store, kDims), states[n])) << n;
    ASSERT_EQ(store.hash(), hashes[n]) << n;
  };
  for (std::size_t n = 12; n-- > 0;) {
    ASSERT_EQ(store.undo(), 1U);
    expect_state(n);
  }
  EXPECT_EQ(store.undo(), 0U);
  EXPECT_EQ(store.n_stored_blocks(), 0U);
  for (std::size_t n = 1; n <= 12; ++n) {
    ASSERT_EQ(store.redo(), 1U);
    expect_state(n);
  }
  EXPECT_EQ(store.redo(), 0U);
  EXPECT_EQ(store.undo(5), 5U);
  expect_state(7);
}

/// Every sample of a volume, whatever its kind, by dense_view and plain reads.
template <class T>
std::vector<T> through_reader(const VolumeReader& reader, const IndexBox& box) {
  std::vector<T> out;
  const auto collect = [&](const SlabReader& slabs) {
    const Index3 dims = slabs.volume().lattice.dims();
    Slab slab;
    for (std::int32_t k0 = 0; k0 < dims[2]; k0 += 5) {
      const std::int32_t k1 = std::min(k0 + 5, dims[2]);
      slabs.read(k0, k1, slab);
      for (const std::byte* plane : slab.planes) {
        for (std::int32_t j = 0; j < dims[1]; ++j) {
          for (std::int32_t i = 0; i < dims[0]; ++i) {
            const std::byte* at = plane + static_cast<std::size_t>(j) * slab.row_stride_bytes +
                                  static_cast<std::size_t>(i) * sizeof(T);
            out.push_back(slabs.volume().endian == std::endian::native
                              ? field::load_sample<T, false>(at)
                              : field::load_sample<T, true>(at));
          }
        }
      }
    }
  };
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    collect(**dense);
  } else {
    collect(*dense_view(*std::get<std::unique_ptr<LeafReader>>(reader), box));
  }
  return out;
}

TYPED_TEST(EditLaws, ReadersGiveTheEditedVolume) {
  for (std::uint64_t seed = 20; seed < 24; ++seed) {
    Trial<TypeParam> trial(seed, true, kPlaces[seed % kPlaces.size()]);
    EditStore store(trial.input, trial.rules);
    for (int n = 0; n < 6; ++n) {
      store.apply(seed == 22 && n == 2 ? Edit{.op = EditOp::fill, .value = 2} : trial.edits.next());
      const IndexBox box = store.volume().lattice.box;
      ASSERT_TRUE(same_bits(through_reader<TypeParam>(store.reader(), box),
                            read_all<TypeParam>(store, kDims)))
          << "seed " << seed << ", edit " << n;
    }
  }
}

TYPED_TEST(EditLaws, SparseIsDenseAsAField) {
  // Brushes stay within the dense volume, so that both have the same samples to change.
  constexpr Index3 kWhole{40, 40, 40};
  for (std::uint64_t seed = 30; seed < 33; ++seed) {
    auto samples = random_field<TypeParam>({16, 16, 16}, Noise::plateaus, seed);
    const TypeParam background = samples[0];
    std::vector<TypeParam> whole(40 * 40 * 40, background);
    for (int n = 0; n < 4096; ++n) {
      const int at = ((n / 256 + 8) * 40 + n / 16 % 16 + 8) * 40 + n % 16 + 8;
      whole[static_cast<std::size_t>(at)] = samples[static_cast<std::size_t>(n)];
    }
    auto leaves =
        std::make_unique<MemoryLeaves>(samples, Index3{16, 16, 16}, Index3{8, 8, 8}, background);
    leaves->add_tile({{0, 0, 32}, 8, Scalar::of(samples[1]), true});
    for (int n = 0; n < 512; ++n) {
      whole[static_cast<std::size_t>(((n / 64 + 32) * 40 + n / 8 % 8) * 40 + n % 8)] = samples[1];
    }
    const VolumeReader sparse = std::move(leaves);
    const VolumeReader dense = std::make_unique<MemorySlabs>(whole, kWhole);
    const EditRules rules{true, test_iso<TypeParam>(), {}};
    EditStore a(sparse, rules);
    EditStore b(dense, rules);
    RandomEdits edits(seed, {{20, 20, 20}, 4, 2, 1});
    for (int n = 0; n < 12; ++n) {
      Edit edit = edits.next();
      if (edit.shape.type == ShapeType::plane || edit.op == EditOp::smooth) continue;
      edit.mirror.reset();
      edit.radial.reset();
      a.apply(edit);
      b.apply(edit);
      ASSERT_TRUE(same_bits(read_all<TypeParam>(a, kWhole), read_all<TypeParam>(b, kWhole)))
          << seed << " " << n;
    }
    const IndexBox box{{0, 0, 0}, {39, 39, 39}};
    ASSERT_TRUE(
        same_bits(through_reader<TypeParam>(a.reader(), box), read_all<TypeParam>(b, kWhole)));
  }
}

}  // namespace

}  // namespace mc::test
