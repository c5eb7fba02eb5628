/* grainlaw as a generic behaviour of the MFront / MGIS ABI (API version 1: TFEL 3.4.1 and 4, MGIS
 * 1.2.1 and later), for OpenGeoSys, MFEM-MGIS, MoFEM, code_aster, mgis.fenics.
 *
 * A whole behaviour library is
 *
 *     #include <grainlaw/mgis.h>
 *     GRAINLAW_MGIS_BEHAVIOUR(Sand, "sand.toml")
 *
 *     cc -shared -fPIC sand.c -o libSand.so -lgrainlaw_mgis
 *
 * and a host names it by library libSand.so and behaviour Sand, hypothesis PlaneStrain or
 * Tridimensional. One behaviour per material file, because library and behaviour are the only texts
 * that every MGIS host lets its users write: material properties and parameters are numbers. A
 * relative path starts at the folder of the library; the environment variable
 * GRAINLAW_MATERIAL_Sand, when set, goes before it, a relative one from the working directory in
 * which libgrainlaw_mgis was loaded. A library may hold several behaviours.
 *
 * What the host sees:
 * - gradient DeformationGradient;
 * - force Stress: Cauchy, PK2 or PK1 as the host asks;
 * - tangents: any of dsigma/dF, dS/dE, dP/dF, dtau/d(dF);
 * - elastic and secant operators: the elastic tangent;
 * - prediction operators;
 * - internal state variables GrainlawPoint and GrainlawStep, which name the state of the point:
 *   start them at zero and keep them as they are;
 * - external state variable Temperature, not used;
 * - no material property, no parameter.
 *
 * A packing of discs is plane strain: F33 = 1, stress out of the plane is 0.
 *
 * Returned:
 * - 1: an equilibrium was found;
 * - 0: it was only found by advancing the friction history (approximate, rdt = 0.5);
 * - -1: failure, with a text in error_message. Nothing of the host's is changed, and the state is
 *   as it was committed. rdt < 1 comes with failures that a smaller step may cure; other failures
 *   leave it alone.
 */
#ifndef GRAINLAW_MGIS_H
#define GRAINLAW_MGIS_H

#include <stddef.h>

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

/* State of the material at the start (s0, read only) or end (s1) of the time step. */
typedef struct grainlaw_mgis_state {
  double* gradients;                /* F11 F22 F33 F12 F21 (F13 F31 F23 F32) */
  double* thermodynamic_forces;     /* Pa; symmetric: 11 22 33 r12 (r13 r23), r = sqrt(2) */
  double* mass_density;             /* not used */
  double* material_properties;      /* not used */
  double* internal_state_variables; /* GrainlawPoint, GrainlawStep */
  double* stored_energy;            /* not used */
  double* dissipated_energy;        /* not used */
  double* external_state_variables; /* not used */
} grainlaw_mgis_state;

/* The struct that a host hands over: mfront_gb_BehaviourData, mgis_bv_BehaviourDataView. */
typedef struct grainlaw_mgis_data {
  char* error_message;    /* NULL or 512 characters */
  double dt;              /* time increment, for solver.viscous_rate or solver.inertia */
  double* K;              /* in: request, stress, tangent; out: tangent, row by row [Pa] */
  double* rdt;            /* factor on the time step */
  double* speed_of_sound; /* not computed */
  grainlaw_mgis_state s0;
  grainlaw_mgis_state s1;
} grainlaw_mgis_data;

typedef struct grainlaw_mgis_behaviour {
  const char* name;
  const char* material; /* path of the material file */
  void* points;         /* made by the first call */
} grainlaw_mgis_behaviour;

/* dimension 2: PlaneStrain, 3: Tridimensional. Any number of threads at once. */
GRAINLAW_API int grainlaw_mgis_integrate(grainlaw_mgis_behaviour*, int dimension,
                                         grainlaw_mgis_data*);

/* States in memory now: those of points that went through an increment. They are freed when they are
 * idle and all together exceed the budget GRAINLAW_IDLE_MEMORY [MiB, default 1024]. A state is idle
 * when it has not been asked for during four calls per state in memory. */
GRAINLAW_API size_t grainlaw_mgis_states(const grainlaw_mgis_behaviour*);

/* Free all states at the end of an analysis; the next starts anew. No thread may be inside. */
GRAINLAW_API void grainlaw_mgis_release(grainlaw_mgis_behaviour*);

#ifdef __cplusplus
}
#endif

/* The symbols that the generic interface of MFront 4 exports for a behaviour NAME. */
#define GRAINLAW_MGIS_BEHAVIOUR(NAME, MATERIAL)                                                  \
  static grainlaw_mgis_behaviour grainlaw_behaviour_##NAME = {#NAME, MATERIAL, NULL};            \
  GRAINLAW_API const char* NAME##_author = "grainlaw";                                           \
  GRAINLAW_API const char* NAME##_date = "";                                                     \
  GRAINLAW_API const char* NAME##_description = "a packing of grains";                           \
  GRAINLAW_API const char* NAME##_build_id = "";                                                 \
  GRAINLAW_API const char* NAME##_mfront_ept = #NAME;                                            \
  GRAINLAW_API const char* NAME##_mfront_interface = "Generic";                                  \
  GRAINLAW_API const char* NAME##_src = MATERIAL;                                                \
  GRAINLAW_API unsigned short NAME##_mfront_mkt = 1;                                             \
  GRAINLAW_API unsigned short NAME##_api_version = 1;                                            \
  GRAINLAW_API unsigned short NAME##_nModellingHypotheses = 2;                                   \
  GRAINLAW_API const char* NAME##_ModellingHypotheses[2] = {"PlaneStrain", "Tridimensional"};    \
  GRAINLAW_API unsigned short NAME##_BehaviourType = 2;      /* finite strain */                 \
  GRAINLAW_API unsigned short NAME##_BehaviourKinematic = 3; /* F and Cauchy */                  \
  GRAINLAW_API unsigned short NAME##_SymmetryType = 0;                                           \
  GRAINLAW_API unsigned short NAME##_ElasticSymmetryType = 0;                                    \
  GRAINLAW_API unsigned short NAME##_nMainVariables = 1;                                         \
  GRAINLAW_API unsigned short NAME##_nGradients = 1;                                             \
  GRAINLAW_API const char* NAME##_Gradients[1] = {"DeformationGradient"};                        \
  GRAINLAW_API int NAME##_GradientsTypes[1] = {3};                                               \
  GRAINLAW_API unsigned short NAME##_nThermodynamicForces = 1;                                   \
  GRAINLAW_API const char* NAME##_ThermodynamicForces[1] = {"Stress"};                           \
  GRAINLAW_API int NAME##_ThermodynamicForcesTypes[1] = {1};                                     \
  GRAINLAW_API unsigned short NAME##_nTangentOperatorBlocks = 2;                                 \
  GRAINLAW_API const char* NAME##_TangentOperatorBlocks[2] = {"Stress", "DeformationGradient"};  \
  GRAINLAW_API unsigned short NAME##_nMaterialProperties = 0;                                    \
  GRAINLAW_API const char* const* NAME##_MaterialProperties = NULL;                              \
  GRAINLAW_API unsigned short NAME##_nInternalStateVariables = 2;                                \
  GRAINLAW_API const char* NAME##_InternalStateVariables[2] = {"GrainlawPoint", "GrainlawStep"}; \
  GRAINLAW_API int NAME##_InternalStateVariablesTypes[2] = {0, 0};                               \
  /* Temperature goes without saying, as in any MFront behaviour: hosts set it unasked. */       \
  GRAINLAW_API unsigned short NAME##_TemperatureRemovedFromExternalStateVariables = 1;           \
  GRAINLAW_API unsigned short NAME##_nExternalStateVariables = 0;                                \
  GRAINLAW_API const char* const* NAME##_ExternalStateVariables = NULL;                          \
  GRAINLAW_API const int* NAME##_ExternalStateVariablesTypes = NULL;                             \
  GRAINLAW_API unsigned short NAME##_nParameters = 0;                                            \
  GRAINLAW_API const char* const* NAME##_Parameters = NULL;                                      \
  GRAINLAW_API const int* NAME##_ParametersTypes = NULL;                                         \
  GRAINLAW_API unsigned short NAME##_requiresStiffnessTensor = 0;                                \
  GRAINLAW_API unsigned short NAME##_requiresThermalExpansionCoefficientTensor = 0;              \
  GRAINLAW_API unsigned short NAME##_UsableInPurelyImplicitResolution = 0;                       \
  GRAINLAW_API unsigned short NAME##_ComputesInternalEnergy = 0;                                 \
  GRAINLAW_API unsigned short NAME##_ComputesDissipatedEnergy = 0;                               \
  GRAINLAW_API unsigned short NAME##_nInitializeFunctions = 0;                                   \
  GRAINLAW_API const char* const* NAME##_InitializeFunctions = NULL;                             \
  GRAINLAW_API unsigned short NAME##_nPostProcessings = 0;                                       \
  GRAINLAW_API const char* const* NAME##_PostProcessings = NULL;                                 \
  GRAINLAW_API int NAME##_PlaneStrain(grainlaw_mgis_data* data) {                                \
    return grainlaw_mgis_integrate(&grainlaw_behaviour_##NAME, 2, data);                         \
  }                                                                                              \
  GRAINLAW_API int NAME##_Tridimensional(grainlaw_mgis_data* data) {                             \
    return grainlaw_mgis_integrate(&grainlaw_behaviour_##NAME, 3, data);                         \
  }                                                                                              \
  GRAINLAW_API size_t NAME##_states(void) {                                                      \
    return grainlaw_mgis_states(&grainlaw_behaviour_##NAME);                                     \
  }                                                                                              \
  GRAINLAW_API void NAME##_release(void) { grainlaw_mgis_release(&grainlaw_behaviour_##NAME); }  \
  __attribute__((destructor)) static void grainlaw_unload_##NAME(void) { NAME##_release(); }

#endif
