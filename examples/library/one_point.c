/* One material point, from C: a periodic cell of grains pulled along y until it breaks. */

#include <feldspar/feldspar_c.h>

#include <stdio.h>
#include <stdlib.h>

static void end_by_error(void)
{
  fprintf(stderr, "%s\n", feldspar_last_error());
  exit(2);
}

int main(void)
{
  feldspar_input* const rock = feldspar_input_new(NULL);
  if (!rock || feldspar_input_set(rock, "Specimen/Shape", "periodic") ||
      feldspar_input_set(rock, "Specimen/Width", "10 mm") || feldspar_input_set(rock, "Specimen/Height", "10 mm"))
    end_by_error();
  feldspar_specimen* const cell = feldspar_specimen_new(rock, 1);
  if (!cell)
    end_by_error();
  const feldspar_specimen* const cells[] = {cell};
  feldspar_volumes* const point = feldspar_volumes_new(cells, 1, rock, 1, NULL);
  if (!point)
    end_by_error();

  printf("strain_yy,stress_yy_MPa\n");
  uint64_t accepted = 0;
  for (int k = 0; k <= 30; ++k)
    {
      const double strain[3] = {0.0, 1e-5 * k, 0.0};
      double stress[3];
      if (feldspar_volumes_update(point, strain, accepted, 1, stress, NULL, &accepted))
        end_by_error();
      printf("%.2e,%.4f\n", strain[1], stress[1] / 1e6);
    }

  /* A mistake is an error to be asked for, here a strain of 100. */
  const double too_large[3] = {0.0, 100.0, 0.0};
  double stress[3];
  if (!feldspar_volumes_update(point, too_large, accepted, 1, stress, NULL, &accepted))
    return EXIT_FAILURE;
  printf("# %s\n", feldspar_last_error());

  feldspar_volumes_free(point);
  feldspar_specimen_free(cell);
  feldspar_input_free(rock);
  return EXIT_SUCCESS;
}
