#include "interfaces/points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <numbers>

/// The generic interface of MFront behaviours, as MGIS loads it (T. Helfer and others, github.com/thelfer/
/// MFrontGenericInterfaceSupport, include/MGIS/Behaviour): behaviour Feldspar of the hypothesis Tridimensional. The input is that
/// of the environment variable FELDSPAR_MATERIAL. docs/material.md.
namespace feldspar::interfaces
{
namespace
{
/// A state at the end of a step; at its beginning all is constant.
struct StateView
{
  double* gradients;            ///< strain: xx, yy, zz, √2 xy, √2 xz, √2 yz
  double* thermodynamic_forces; ///< stress, the same
  double* mass_density;
  double* material_properties;      ///< the number of the point
  double* internal_state_variables; ///< token and fields
  double* stored_energy;
  double* dissipated_energy;
  double* external_state_variables;
};

/// The data of a point, as a code hands them over.
struct BehaviourDataView
{
  char* error_message; ///< null, or of 512 characters
  double dt;
  double* K; ///< at first its first number says what is wanted; then the tangent, rows first
  double* rdt;
  double* speed_of_sound;
  StateView s0;
  StateView s1;
};

/// Feldspar's xx, yy, zz, yz, xz, xy among the components of the interface.
constexpr std::array<std::size_t, 6> places{0, 1, 2, 5, 4, 3};

/// Engineering shear over the component of the interface; of stress its inverse.
double shear_of(const std::size_t component) { return component < 3 ? 1.0 : std::numbers::sqrt2; }

Points& points()
{
  static const std::unique_ptr<Points> all = [] {
    const char* const material = std::getenv("FELDSPAR_MATERIAL");
    if (material == nullptr)
      throw Error("FELDSPAR_MATERIAL is not set; it names the input of the volume, without .prm");
    return std::make_unique<Points>(input_file_of(material), std::string(material) + ".feldspar", Breaking::lagged);
  }();
  return *all;
}

int integrate(BehaviourDataView& data)
{
  Points& all = points();
  if (all.dimension() == 2)
    throw Error("the hypothesis Tridimensional needs a volume of spheres, Specimen/Dimension = 3");
  std::array<double, 6> before{}, strain{};
  for (std::size_t c = 0; c < 6; ++c)
    {
      before[c] = shear_of(c) * data.s0.gradients[places[c]];
      strain[c] = shear_of(c) * data.s1.gradients[places[c]];
    }
  const bool wants_tangent = std::abs(data.K[0] >= 50.0 ? data.K[0] - 100.0 : data.K[0]) > 0.5;
  const PointName name{0, std::uint32_t(data.s1.material_properties[0])};
  const Answer& answer = all.respond(name, std::uint64_t(data.s0.internal_state_variables[0]), before, strain);
  if (!answer.in_equilibrium)
    {
      *data.rdt = 0.25;
      return -1;
    }
  for (std::size_t a = 0; a < 6; ++a)
    {
      data.s1.thermodynamic_forces[places[a]] = answer.stress[a] * shear_of(a);
      for (std::size_t b = 0; b < 6 && wants_tangent; ++b)
        data.K[6 * places[a] + places[b]] = answer.tangent[6 * a + b] * shear_of(a) * shear_of(b);
    }
  std::ranges::copy(answer.states, data.s1.internal_state_variables);
  return 1;
}
} // namespace
} // namespace feldspar::interfaces

extern "C"
{
  FELDSPAR_PUBLIC int Feldspar_Tridimensional(feldspar::interfaces::BehaviourDataView* const data)
  {
    try
      {
        return feldspar::interfaces::integrate(*data);
      }
    catch (const std::exception& error)
      {
        if (data->error_message != nullptr)
          std::snprintf(data->error_message, 512, "%s", error.what());
        return -1;
      }
  }

  // The description of the behaviour, which a loader reads.
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_mfront_mkt = 1; // a behaviour
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_api_version = 1;
  FELDSPAR_PUBLIC extern const char* const Feldspar_mfront_ept = "Feldspar";
  FELDSPAR_PUBLIC extern const char* const Feldspar_mfront_interface = "Generic";
  FELDSPAR_PUBLIC extern const char* const Feldspar_tfel_version = "";
  FELDSPAR_PUBLIC extern const char* const Feldspar_src = "Feldspar";
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_nModellingHypotheses = 1;
  FELDSPAR_PUBLIC extern const char* const Feldspar_ModellingHypotheses[] = {"Tridimensional"};
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_BehaviourType = 1;      // strain based
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_BehaviourKinematic = 1; // small strains
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_SymmetryType = 0;
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_ElasticSymmetryType = 0;
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_requiresStiffnessTensor = 0;
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_requiresThermalExpansionCoefficientTensor = 0;
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_nGradients = 1;
  FELDSPAR_PUBLIC extern const int Feldspar_GradientsTypes[] = {1}; // a symmetric tensor
  FELDSPAR_PUBLIC extern const char* const Feldspar_Gradients[] = {"Strain"};
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_nThermodynamicForces = 1;
  FELDSPAR_PUBLIC extern const int Feldspar_ThermodynamicForcesTypes[] = {1};
  FELDSPAR_PUBLIC extern const char* const Feldspar_ThermodynamicForces[] = {"Stress"};
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_nTangentOperatorBlocks = 2;
  FELDSPAR_PUBLIC extern const char* const Feldspar_TangentOperatorBlocks[] = {"Stress", "Strain"};
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_nMaterialProperties = 1;
  FELDSPAR_PUBLIC extern const char* const Feldspar_MaterialProperties[] = {"PointNumber"};
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_nInternalStateVariables = 6;
  FELDSPAR_PUBLIC extern const int Feldspar_InternalStateVariablesTypes[] = {0, 0, 0, 0, 0, 1};
  FELDSPAR_PUBLIC extern const char* const Feldspar_InternalStateVariables[] = {
    "Token", "BrokenShare", "BrokenInShearShare", "Dissipation", "CrackDensity", "CrackOrientation"};
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_nExternalStateVariables = 0;
  FELDSPAR_PUBLIC extern const char* const Feldspar_ExternalStateVariables[] = {nullptr};
  FELDSPAR_PUBLIC extern const unsigned short Feldspar_nParameters = 0;
  FELDSPAR_PUBLIC extern const char* const Feldspar_Parameters[] = {nullptr};
  FELDSPAR_PUBLIC extern const int Feldspar_ParametersTypes[] = {0};
}
