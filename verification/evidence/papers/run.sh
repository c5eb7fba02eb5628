# shellcheck shell=bash disable=SC2154
# The papers' scenes, what is computed from their results, and the pages: sourced by verification/run, which
# sets root, scenes, grainlaw, evidence and output. Each function takes the scenes to run, or none for all.

scenes_liu2017_boundary=(figure_02 figure_05 figure_08 figure_10 sizes sizes_rough order_regular order_irregular figure_12 figure_12_more
  layer_strength layer_rows rolling locked_rotation servo_regular servo_irregular servo_layer published)
scenes_liu2018_waves=(figure_4_4 figure_4_5 figure_4_6 figure_4_7 figure_4_8 figure_4_8_650 figure_4_10 why inertia
  shear_wave)
scenes_liu2019_biaxial=(biaxial_1x1 biaxial_1x2 biaxial_2x4 biaxial_4x8 biaxial_4x8_membrane friction_02 friction_06 locked
  anisotropy dns_a dns_b dns_packings published_explicit published_newton)
short_guo2014_multiscale=(biaxial_2x4 element_perturbed element_elastic element_exact biaxial_2x4_hexagonal cyclic_stress_column
  cyclic_strain_column biaxial_2x4_full biaxial_2x4_fine biaxial_2x4_coarse biaxial_2x4_100)
# The longest first, so that no processor is left without work at the end.
scenes_guo2014_multiscale=(cyclic_strain_15x10 cyclic_stress_15x10 biaxial_6x10_q8 biaxial_12x20 biaxial_10x15 biaxial_6x10
  biaxial_6x10_fine biaxial_6x10_full biaxial_6x10_hexagonal cyclic_strain_3x2 cyclic_stress_3x2
  cyclic_{strain,stress}_seed_{1..9} biaxial_3x5 biaxial_3x5_full "${short_guo2014_multiscale[@]}")

liu2017_boundary() {
  local scene jobs size
  if (($# == 0)); then set -- "${scenes_liu2017_boundary[@]}"; fi
  jobs=$(nproc)
  for size in 37 120 228 444 650; do
    "$grainlaw" pack "$scenes/liu2017_boundary/pack_$size.toml" --output "$output" --vtk
  done
  for scene in "$@"; do
    echo "== $scene"
    if [[ $scene == published ]]; then  # the algorithms of the paper, which are no scene
      "$evidence" --scenes "$scenes" --output "$output" liu2017_published
      continue
    fi
    "$grainlaw" point "$scenes/liu2017_boundary/$scene.toml" --output "$output" --jobs "$jobs"
  done
  "$evidence" --scenes "$scenes" --output "$output" liu2017_boundary
  with_python "$root/verification/evidence/papers/liu2017_boundary/by_particles" "$output"
  "$root/verification/evidence/report/make_liu2017_boundary_page" "$output"
}

liu2018_waves() {
  local scene kind
  if (($# == 0)); then set -- "${scenes_liu2018_waves[@]}"; fi
  for scene in "$@"; do
    kind=wave
    [[ $scene == shear_wave ]] && kind=solve
    "$grainlaw" $kind "$scenes/liu2018_waves/$scene.toml" --output "$output" || echo "$scene ended early"
  done
  "$evidence" --scenes "$scenes" --output "$output" liu2018_waves
  "$root/verification/evidence/report/make_liu2018_waves_page" "$output"
}

# `timed NAME COMMAND...`: leaves "elapsed,processor time" [s] in NAME.time beside the results.
timed() {
  local name=$1 TIMEFORMAT='%R,%U'
  shift
  { time "$@" 2>&3; } 3>&2 2>"$output/$name.time"
}

# A mesh whose last steps do not balance is still compared as far as it came.
liu2019_biaxial() {
  local scene kind failed=()
  if (($# == 0)); then set -- "${scenes_liu2019_biaxial[@]}"; fi
  for scene in packing packing_{across,along}_{005,008}; do
    "$grainlaw" pack "$scenes/liu2019_biaxial/$scene.toml" --output "$output"
  done
  for scene in "$@"; do
    echo "== $scene"
    kind=solve
    [[ $scene == anisotropy ]] && kind="point --jobs $(nproc)"
    [[ $scene == dns_* ]] && kind="dns --jobs $(nproc)"
    # shellcheck disable=SC2086
    timed "$scene" "$grainlaw" $kind "$scenes/liu2019_biaxial/$scene.toml" --output "$output" || failed+=("$scene")
  done
  "$evidence" --scenes "$scenes" --output "$output" liu2019_biaxial
  with_python "$root/verification/evidence/papers/liu2019_biaxial/by_cells" "$output"
  "$root/verification/evidence/report/make_liu2019_biaxial_page" "$output"
  ((${#failed[@]} == 0)) || echo "ended early: ${failed[*]}"
}

# `with_seed strain|stress SEED`: that column of two points with another loose packing; says where its scene is. Under strain
# control it goes on below the vertical stress that the paper ends at.
with_seed() {
  local from=$scenes/guo2014_multiscale packing=loose_$1_$2
  sed "s/^seed = .*/seed = $2/" "$from/pack_loose_$1.toml" >"$output/$packing.toml"
  "$grainlaw" pack "$output/$packing.toml" --output "$output" >&2
  sed "s/loose_$1_/${packing}_/; /^vtk_every/d; /^packings/d; s/^end_mean_stress = .*/end_mean_stress = 2e3/
    s/^steps = .*/steps = 2400/; s/^cycles = .*/cycles = 20/" "$from/cyclic_$1_column.toml" >"$output/cyclic_$1_seed_$2.toml"
  echo "$output/cyclic_$1_seed_$2.toml"
}

# Single points, then meshes, one on every processor, then what is computed from them, then the page. A
# mesh that does not get to its end is compared as far as it came.
guo2014_multiscale() {
  local scene file
  if [[ ${1:-} == --short ]]; then set -- "${short_guo2014_multiscale[@]}"; fi
  if (($# == 0)); then set -- "${scenes_guo2014_multiscale[@]}"; fi
  for scene in rve rve_fine rve_far rve_hexagonal rve_hexagonal_spread; do
    "$grainlaw" point "$scenes/guo2014_multiscale/$scene.toml" --output "$output" || echo "$scene ended early"
  done
  "$evidence" --scenes "$scenes" --output "$output" batch --points 16
  for scene in "$@"; do
    while (($(jobs -rp | wc -l) >= $(nproc))); do wait -n || true; done
    file=$scenes/guo2014_multiscale/$scene.toml
    if [[ $scene == cyclic_*_seed_* ]]; then
      file=${scene#cyclic_}
      file=$(with_seed "${file%%_*}" "${scene##*_}")
    fi
    { "$grainlaw" solve "$file" --output "$output" --restart || echo "$scene ended early"; } &
  done
  wait
  "$evidence" --scenes "$scenes" --output "$output" guo2014_multiscale
  with_python "$root/verification/evidence/papers/guo2014_multiscale/by_points" "$output"
  with_python "$root/verification/evidence/papers/guo2014_multiscale/alone" "$scenes" "$output"
  "$root/verification/evidence/report/make_guo2014_multiscale_page" "$output"
}
