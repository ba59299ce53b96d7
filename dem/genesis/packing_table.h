#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

namespace feldspar
{
/// A grain as a file of a packing has it [m].
struct PackedGrain
{
  std::size_t line;             ///< of the file
  std::vector<double> position; ///< [dim]
  double radius;
};

/// Two grains that a file says are bonded, by their places among its grains.
struct PackedBond
{
  std::size_t line; ///< of the file
  std::size_t first;
  std::size_t second;
};

struct PackingTable
{
  std::vector<PackedGrain> grains;
  std::vector<PackedBond> bonds;
};

/// Reads the grains of a packing made elsewhere, in the plane (dim = 2: x and y) or in space. The file is one of
/// - lines of numbers `x y [z] radius`, before which a number of the grain may stand, as YADE's export.text writes them; in the
///   plane z may stand there too, the same for all,
/// - the same with a line `#format x_y_z_r_matId`, as YADE's export.textExt writes it, which names the columns,
/// - a table with column names, among them x, y, z (or x_m, or position_x) and radius (or r, or diameter), each perhaps with its
///   unit, `x [mm]`. Feldspar's own grains/*.csv are such tables,
/// - a dump of LAMMPS with the columns x, y, z and radius or diameter, of which the last step counts,
/// - a data file of LAMMPS with atoms of style sphere, of bpm/sphere or of a hybrid with sphere, and perhaps bonds.
/// `unit` is the length of 1 in a column without a unit [m]. Positions in files of LAMMPS are counted from the lower corner of
/// their box. Blanks, tabs, commas and semicolons separate numbers; # begins a comment. Throws InputError with file and line of
/// whatever is not so. `check` is called now and then and may throw to end it.
PackingTable read_packing_table(const std::filesystem::path& file, int dim, double unit,
                                const std::function<void()>& check);
} // namespace feldspar
