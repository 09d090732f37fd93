// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "base/parallel.hpp"
#include "field/visit_type.hpp"
#include "mc/field.hpp"
#include "support/memory_readers.hpp"

namespace mc {
namespace {

using test::MemoryLeaves;
using test::MemorySlabs;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FieldStatistics measure(const VolumeReader& reader, const std::vector<double>& percentiles = {}) {
  return measure_field(reader, percentiles, silent_progress(), {});
}

template <class T>
VolumeReader dense(const std::vector<T>& samples, Index3 dims,
                   std::endian endian = std::endian::native) {
  MemorySlabs::Layout layout;
  layout.endian = endian;
  layout.lead = 1;
  return std::make_unique<MemorySlabs>(samples, dims, layout);
}

template <class T>
VolumeReader line(const std::vector<T>& samples) {
  return dense(samples, {static_cast<std::int32_t>(samples.size()), 1, 1});
}

/// Samples that use the whole range of T, with NaN and infinities where T has them.
template <class T>
std::vector<T> wild(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<T> out;
  for (std::size_t i = 0; i < n; ++i) {
    if constexpr (std::is_integral_v<T>) {
      out.push_back(static_cast<T>(random() >> (random() % 60)));
    } else {
      const double value =
          i % 17 == 3 ? kNan
                      : (i % 29 == 5 ? (i % 2 == 0 ? kInf : -kInf)
                                     : std::ldexp(static_cast<double>(random() % 20001) - 10000,
                                                  static_cast<int>(random() % 8) - 12));
      if constexpr (std::is_same_v<T, Half>) {
        out.push_back(to_half(static_cast<float>(value)));
      } else {
        out.push_back(static_cast<T>(value));
      }
    }
  }
  return out;
}

/// Everything but the threshold, from a sorted copy.
template <class T>
FieldStatistics sorted_statistics(const std::vector<T>& samples,
                                  const std::vector<double>& percentiles) {
  FieldStatistics out;
  std::vector<double> numbers;
  double sum = 0;
  std::size_t n_finite = 0;
  for (const T sample : samples) {
    const auto value = static_cast<double>(field::number(sample));
    ++out.n_samples;
    if (std::isnan(value)) {
      ++out.n_nan;
      continue;
    }
    numbers.push_back(value);
    if (std::isinf(value)) {
      ++out.n_infinite;
    } else {
      sum += value;
      out.min = n_finite == 0 ? value : std::min(out.min, value);
      out.max = n_finite == 0 ? value : std::max(out.max, value);
      ++n_finite;
    }
  }
  out.mean = sum / static_cast<double>(n_finite);
  std::sort(numbers.begin(), numbers.end());
  for (const double p : percentiles) {
    std::size_t rank = 1;  // the least that p per cent of the numbers do not exceed
    while (static_cast<double>(rank) * 100 < p * static_cast<double>(numbers.size())) ++rank;
    out.percentiles.push_back(numbers[rank - 1]);
  }
  return out;
}

template <class T>
class Statistics : public testing::Test {};
using Types = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                             std::int32_t, std::int64_t, Half, float, double>;
TYPED_TEST_SUITE(Statistics, Types);

TYPED_TEST(Statistics, EqualThoseOfASortedCopyInBothByteOrders) {
  const Index3 dims{19, 7, 23};
  const auto samples = wild<TypeParam>(19 * 7 * 23, 5);
  std::vector<double> asked{50, 0, 100, 99.9, 0.01, 7};
  for (int n = 0; n < 20; ++n) asked.push_back(5.0 * n);  // more than share one pass
  const FieldStatistics want = sorted_statistics(samples, asked);
  for (const std::endian endian : {std::endian::little, std::endian::big}) {
    const FieldStatistics got = measure(dense(samples, dims, endian), asked);
    EXPECT_EQ(got.n_samples, want.n_samples);
    EXPECT_EQ(got.n_nan, want.n_nan);
    EXPECT_EQ(got.n_infinite, want.n_infinite);
    EXPECT_EQ(got.min, want.min);
    EXPECT_EQ(got.max, want.max);
    EXPECT_NEAR(got.mean, want.mean, 1e-12 * (want.max - want.min));
    EXPECT_EQ(got.percentiles, want.percentiles);
  }
}

TYPED_TEST(Statistics, DoNotDependOnTheThreads) {
  const auto samples = wild<TypeParam>(16 * 16 * 200, 9);
  const auto at = [&](int n_threads) {
    const base::ThreadLimit limit(n_threads);
    return measure(dense(samples, {16, 16, 200}), {50});
  };
  const FieldStatistics one = at(1);
  for (const int n_threads : {2, 7}) {
    const FieldStatistics many = at(n_threads);
    EXPECT_EQ(one.mean, many.mean);
    EXPECT_EQ(one.otsu, many.otsu);
    EXPECT_EQ(one.percentiles, many.percentiles);
  }
}

/// The upper class's first value where the variance between the classes is greatest: tries every
/// split of the sorted samples from its definition.
double naive_split(std::vector<double> sorted) {
  std::sort(sorted.begin(), sorted.end());
  double best = -1;
  double value = kNan;
  for (std::size_t n = 1; n < sorted.size(); ++n) {
    if (sorted[n] == sorted[n - 1]) continue;
    const auto mean = [&](std::size_t from, std::size_t to) {
      double sum = 0;
      for (std::size_t i = from; i < to; ++i) sum += sorted[i];
      return sum / static_cast<double>(to - from);
    };
    const double apart = mean(0, n) - mean(n, sorted.size());
    const double between =
        static_cast<double>(n) * static_cast<double>(sorted.size() - n) * apart * apart;
    if (between > best * (1 + 1e-9)) {
      best = between;
      value = sorted[n];
    }
  }
  return value;
}

template <class T>
std::vector<T> two_humps(std::size_t n, double low, double high, double sigma) {
  std::mt19937 random(11);
  std::normal_distribution<double> lower(low, sigma);
  std::normal_distribution<double> upper(high, sigma);
  std::vector<T> out;
  for (std::size_t i = 0; i < n; ++i) {
    out.push_back(static_cast<T>(i % 3 == 0 ? upper(random) : lower(random)));
  }
  return out;
}

TEST(Otsu, SplitsIntegersWhereTheDefinitionDoes) {
  const auto samples = two_humps<std::int16_t>(999, -500, 400, 120);
  const double otsu = measure(line(samples)).otsu;
  const double first_above = naive_split({samples.begin(), samples.end()});
  double last_below = -kInf;
  for (const double v : samples)
    last_below = v < first_above ? std::max(last_below, v) : last_below;
  EXPECT_EQ(otsu, last_below + 1);
}

TEST(Otsu, SplitsFloatsAtTheEdgeOfABin) {
  const auto samples = two_humps<float>(999, 0.25, 0.75, 0.07);
  const FieldStatistics got = measure(line(samples));
  std::vector<double> binned;
  const double width = (got.max - got.min) / 1024;
  for (const float v : samples) {
    binned.push_back(std::min(1023.0, std::floor((static_cast<double>(v) - got.min) / width)));
  }
  const double first_above = naive_split(binned);
  double last_below = 0;
  for (const double v : binned) last_below = v < first_above ? std::max(last_below, v) : last_below;
  EXPECT_DOUBLE_EQ(got.otsu, got.min + (last_below + 1) * width);
}

TEST(Otsu, TakesTheLowestOfEqualsAndTheValueOfAConstant) {
  EXPECT_EQ(measure(line<std::uint8_t>({10, 10, 200, 200})).otsu, 11);
  EXPECT_EQ(measure(line<std::uint8_t>({7, 7, 7})).otsu, 7);
  EXPECT_EQ(measure(line<float>({7, 7, 7})).otsu, 7);
  EXPECT_EQ(measure(line<float>({0, 0, 1, 1})).otsu, 1.0 / 1024);
  EXPECT_EQ(measure(line<Half>({to_half(0), to_half(2), to_half(2)})).otsu, 2);
}

TEST(Otsu, SurvivesTheLimitsOfDouble) {
  const double huge = std::numeric_limits<double>::max();
  EXPECT_EQ(measure(line<double>({-huge, -huge, huge, huge})).otsu, -huge + huge / 512);
  const double tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_GE(measure(line<double>({0, 0, tiny})).otsu, 0);
}

TEST(StatisticsOfNothing, AreNan) {
  for (const VolumeReader& reader :
       {line<float>({NAN, NAN}), line<Half>({Half{0x7E00}, Half{0xFE00}})}) {
    const FieldStatistics got = measure(reader, {50});
    EXPECT_EQ(got.n_samples, 2U);
    EXPECT_EQ(got.n_nan, 2U);
    EXPECT_TRUE(std::isnan(got.min) && std::isnan(got.max) && std::isnan(got.mean));
    EXPECT_TRUE(std::isnan(got.otsu));
    EXPECT_TRUE(std::isnan(got.percentiles.at(0)));
  }
}

TEST(StatisticsOfInfinities, KeepThemOutOfTheRangeOnly) {
  const FieldStatistics got =
      measure(line<double>({1, kInf, 3, -kInf, kNan, kInf}), {1, 40, 60, 100});
  EXPECT_EQ(got.n_infinite, 3U);
  EXPECT_EQ(got.n_nan, 1U);
  EXPECT_EQ(got.min, 1);
  EXPECT_EQ(got.max, 3);
  EXPECT_EQ(got.mean, 2);
  EXPECT_EQ(got.percentiles, (std::vector<double>{-kInf, 1, 3, kInf}));
}

TEST(StatisticsOfLeaves, LookAtActiveSamplesOnly) {
  std::vector<float> samples(16 * 16 * 16, 0.F);
  for (std::size_t n = 0; n < samples.size(); n += 3) samples[n] = static_cast<float>(n % 37);
  auto leaves = std::make_unique<MemoryLeaves>(samples, Index3{16, 16, 16}, Index3{0, 0, 0}, 0.F);
  leaves->deactivate([](const Index3& p) { return (p[0] + p[1] + p[2]) % 2 == 0; });
  leaves->add_tile({{16, 0, 0}, 8, Scalar::of(100.F), true});
  leaves->add_tile({{24, 0, 0}, 8, Scalar::of(-100.F), false});
  std::vector<float> active(512, 100.F);
  for (int k = 0; k < 16; ++k) {
    for (int j = 0; j < 16; ++j) {
      for (int i = 0; i < 16; ++i) {
        const auto at = static_cast<std::size_t>((k * 16 + j) * 16 + i);
        if ((i + j + k) % 2 != 0) active.push_back(samples[at]);
      }
    }
  }
  const std::vector<double> asked{10, 50, 75, 90};
  const FieldStatistics want = sorted_statistics(active, asked);
  const FieldStatistics got = measure(VolumeReader(std::move(leaves)), asked);
  EXPECT_EQ(got.n_samples, want.n_samples);
  EXPECT_EQ(got.min, want.min);
  EXPECT_EQ(got.max, 100);
  EXPECT_DOUBLE_EQ(got.mean, want.mean);
  EXPECT_EQ(got.percentiles, want.percentiles);
}

class CountingProgress final : public Progress {
 public:
  void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override {
    stages += std::string(stage) + " " + std::to_string(total) + " " + std::string(unit);
  }
  void advance(std::uint64_t n) override { done += n; }
  void note(std::string_view) override {}
  void warn(std::string_view) override {}

  std::string stages;
  std::atomic<std::uint64_t> done{0};
};

TEST(StatisticsProgress, CountsTheSamplesOfAllPasses) {
  std::vector<float> samples(1000);
  samples[3] = 1;
  CountingProgress progress;
  const std::vector<double> asked{50};
  measure_field(dense(samples, {10, 10, 10}), asked, progress, {});
  EXPECT_EQ(progress.stages, "statistics 4000 samples");
  EXPECT_EQ(progress.done, 4000U);
}

TEST(StatisticsProgress, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(measure_field(line<float>({1, 2}), {}, silent_progress(), stop.get_token()),
               Cancelled);
}

}  // namespace
}  // namespace mc
