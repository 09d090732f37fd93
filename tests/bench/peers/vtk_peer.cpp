// SPDX-License-Identifier: MIT
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>

#include "peer.hpp"

// VTK's Flying Edges over a cube of floats, at value 0, without scalars and gradients.
//
//   vtk_peer FILE N BACKEND THREADS plain|kept none|gradient
//
// Each round makes a filter and gives it back, output included, as a loop over volumes would; only
// what the filter does is timed.

int main(int argc, char** argv) {
  return peer::guarded([&] {
    if (argc != 7) throw std::runtime_error("FILE N BACKEND THREADS plain|kept none|gradient");
    const int n = std::atoi(argv[2]);
    if (std::strcmp(argv[5], "kept") == 0) peer::keep_heap();
    vtkSMPTools::SetBackend(argv[3]);
    vtkSMPTools::Initialize(std::atoi(argv[4]));
    const auto n_samples = static_cast<std::size_t>(n) * n * n;
    vtkNew<vtkFloatArray> samples;
    samples->SetArray(peer::load(argv[1], n_samples), static_cast<vtkIdType>(n_samples), 1);
    vtkNew<vtkImageData> image;
    image->SetDimensions(n, n, n);
    image->GetPointData()->SetScalars(samples);
    const bool normals = std::strcmp(argv[6], "gradient") == 0;
    vtkSmartPointer<vtkFlyingEdges3D> filter;
    peer::serve(
        [&] {
          filter = vtkSmartPointer<vtkFlyingEdges3D>::New();
          filter->SetInputData(image);
          filter->SetValue(0, 0);
          filter->SetComputeNormals(normals);
          filter->SetComputeScalars(false);
          filter->SetComputeGradients(false);
        },
        [&] {
          filter->Update();
          return peer::Counts{static_cast<std::uint64_t>(filter->GetOutput()->GetNumberOfPoints()),
                              static_cast<std::uint64_t>(filter->GetOutput()->GetNumberOfPolys())};
        });
  });
}
