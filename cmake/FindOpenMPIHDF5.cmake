# HDF5 as deal.II links it: the OpenMPI build with its C++ interface. A target with the property WITHOUT_MPI gets the serial
# build at its link, which differs in no header but in the names of the versions of its functions: both may lie in one process.
#   OpenMPIHDF5::OpenMPIHDF5

find_package(MPI REQUIRED COMPONENTS C)
find_path(OpenMPIHDF5_INCLUDE_DIR H5Cpp.h PATH_SUFFIXES hdf5/openmpi)
find_library(OpenMPIHDF5_LIBRARY hdf5_openmpi)
find_library(OpenMPIHDF5_CPP_LIBRARY hdf5_openmpi_cpp)
find_library(SerialHDF5_LIBRARY hdf5_serial)
find_library(SerialHDF5_CPP_LIBRARY hdf5_serial_cpp)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenMPIHDF5
  REQUIRED_VARS OpenMPIHDF5_LIBRARY OpenMPIHDF5_CPP_LIBRARY SerialHDF5_LIBRARY SerialHDF5_CPP_LIBRARY
    OpenMPIHDF5_INCLUDE_DIR)

if(OpenMPIHDF5_FOUND AND NOT TARGET OpenMPIHDF5::OpenMPIHDF5)
  add_library(OpenMPIHDF5::OpenMPIHDF5 INTERFACE IMPORTED)
  target_include_directories(OpenMPIHDF5::OpenMPIHDF5 SYSTEM INTERFACE ${OpenMPIHDF5_INCLUDE_DIR} ${MPI_C_INCLUDE_DIRS})
  set(alone $<BOOL:$<TARGET_PROPERTY:WITHOUT_MPI>>)
  target_link_libraries(OpenMPIHDF5::OpenMPIHDF5 INTERFACE
    $<${alone}:${SerialHDF5_CPP_LIBRARY}> $<${alone}:${SerialHDF5_LIBRARY}>
    $<$<NOT:${alone}>:${OpenMPIHDF5_CPP_LIBRARY}> $<$<NOT:${alone}>:${OpenMPIHDF5_LIBRARY}>
    $<$<NOT:${alone}>:MPI::MPI_C>)
endif()
