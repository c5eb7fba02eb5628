import grainlaw

sand = grainlaw.Material("sand.toml")
result = grainlaw.laboratory.drained(sand, strain=0.02)  # 2 % of compression at 100 kPa
print(f"{result.axial_stress[-1] / 1e3:.1f} kPa, void ratio {result.void_ratio[-1]:.4f}")
