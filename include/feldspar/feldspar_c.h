#ifndef FELDSPAR_C_H
#define FELDSPAR_C_H

#include <stddef.h>
#include <stdint.h>

/* Representative volumes for finite-element codes in C, Fortran and other languages: the class Volumes of feldspar.h by
 * handles. SI, tension positive, Voigt's order with engineering shear: xx, yy, xy or xx, yy, zz, yz, xz, xy.
 *
 * A function that makes something returns NULL, any other a number that is not 0, where it fails; feldspar_last_error() then
 * has one line for the user. Nothing is thrown. What _new() made, _free() ends; NULL may be freed. Volumes copy what they need
 * of inputs and specimens. */

#ifdef __cplusplus
extern "C"
{
#endif

  typedef struct feldspar_input feldspar_input;
  typedef struct feldspar_specimen feldspar_specimen;
  typedef struct feldspar_volumes feldspar_volumes;

  /* The error of the last call of this thread that failed; valid until its next call. */
  const char* feldspar_last_error(void);

  /* Reads a .prm or .json file; NULL: an input with presets alone. */
  feldspar_input* feldspar_input_new(const char* file);
  /* Gives an entry, "Flat joint/Modulus", a value, "70 GPa". */
  int feldspar_input_set(feldspar_input* input, const char* entry, const char* value);
  void feldspar_input_free(feldspar_input* input);

  feldspar_specimen* feldspar_specimen_new(const feldspar_input* input, uint64_t seed);
  void feldspar_specimen_free(feldspar_specimen* specimen);

  /* n volumes on n_specimens periodic specimens: those with the numbers `assigned` [n], or all on the first if that is NULL. */
  feldspar_volumes* feldspar_volumes_new(const feldspar_specimen* const* specimens, size_t n_specimens,
                                         const feldspar_input* input, size_t n, const size_t* assigned);
  /* 2 or 3. */
  int feldspar_volumes_dimension(const feldspar_volumes* volumes);
  /* Stresses [n][n_voigt] and, unless that is NULL, tangents [n][n_voigt][n_voigt] at strains [n][n_voigt], from the state of
 * the token `parent` (0: at rest). Bonds break until none is overloaded; where bonds_break is 0, all are kept. The outcome is kept under `token`. A parent is accepted: what came before it, and its
 * siblings, go. */
  int feldspar_volumes_update(feldspar_volumes* volumes, const double* strains, uint64_t parent, int bonds_break,
                              double* stresses, double* tangents, uint64_t* token);
  void feldspar_volumes_free(feldspar_volumes* volumes);

#ifdef __cplusplus
}
#endif

#endif
