// SPDX-License-Identifier: Apache-2.0
// On the workstation: designs a network of five agents and writes what each of them needs into FOLDER.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <garrison/garrison.hpp>

using namespace garrison;

static void write(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  std::printf("%s: %zu bytes\n", path.filename().c_str(), bytes.size());
}

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::filesystem::path folder = arguments[1];
  std::vector<Matrix> C;
  for (int i = 0; i < 5; ++i) C.push_back(Matrix::Identity(2, 2).row(i % 2));
  Noise noise;
  noise.process_bound = 0.01;
  noise.measurement_bound = Vector::Constant(5, 0.01);
  const Model model(Matrix{{0.9, 0.1}, {0.0, 0.9}}, C, noise);
  const auto filter = make_filter("saturation", {{"threshold", 0.5}, {"rounds", std::int64_t{3}}});
  const auto prepared = filter->prepare(model, Network::ring(5));
  write(folder / "network.gdesign", write_design(*prepared));
  for (int i = 0; i < 5; ++i)
    write(folder / ("agent" + std::to_string(i) + ".part"), write_part(*prepared, i));
}
