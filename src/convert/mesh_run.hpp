// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "mc/convert.hpp"
#include "process/stage_list.hpp"

// One volume to one mesh: open, place, choose the surface, check the budget, then run the engine
// once for each isovalue. Everything that can refuse comes before what takes long.

namespace mc::conversion {

class MeshRun {
 public:
  /// Keeps references to all of them.
  MeshRun(const std::string& output, const ConvertOptions& options, Progress& progress,
          const std::stop_token& stop, ConvertReport& report);

  void open(std::span<const std::string> inputs);
  void use(const Source& source);
  /// The opened or given volume as a mesh; of the given surface, if there is one.
  void run(const std::optional<Surface>& surface);

 private:
  void place_mesh();
  void choose_surface();
  void spool_if_read_again();
  void probe_output() const;
  void write();
  template <class Work>
  void timed(const char* stage, Work&& work);
  [[nodiscard]] const VolumeReader& reader() const { return source_->reader; }
  [[nodiscard]] const Volume& volume() const { return volume_of(source_->reader); }
  [[nodiscard]] IndexBox box() const {
    return options_.extract.region.value_or(volume().lattice.box);
  }
  [[nodiscard]] Normals normals() const;
  [[nodiscard]] std::vector<const AttributeReader*> all_attributes();
  void choose_attributes();
  [[nodiscard]] RunOptions run_options(double iso) const;
  [[nodiscard]] SinkOptions sink_options() const;
  [[nodiscard]] FieldStatistics measure(std::span<const double> percentiles);
  [[noreturn]] void refuse_empty(double iso);
  MeshTotals run_one(double iso, MeshSink& sink);
  void report_totals(const MeshTotals& totals) const;
  void report_simplified(const MeshTotals& totals) const;

  const std::string& output_;
  const ConvertOptions& options_;
  process::StageList stages_;
  std::optional<Simplify> simplify_;
  std::vector<const CubeStage*> cube_stages_;
  const SinkFormat& format_;
  Progress& progress_;
  const std::stop_token& stop_;
  ConvertReport& report_;
  std::optional<Source> opened_;
  const Source* source_ = nullptr;
  std::vector<std::unique_ptr<AttributeReader>> sampled_;  // from options_.attributes
  std::uint64_t sampled_bytes_ = 0;                        // that these hold
  std::vector<const AttributeReader*> attributes_;         // those that the output holds
  MeshNeeds needs_;
  Surface surface_;
};

}  // namespace mc::conversion
