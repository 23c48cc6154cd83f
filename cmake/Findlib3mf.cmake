# Finds lib3mf and makes the target lib3mf::lib3mf. Debian's lib3MF.pc names -lzip, whose development package the shared
# library does not need; so pkg-config is not asked.
find_path(LIB3MF_INCLUDE_DIR Model/COM/NMR_DLLInterfaces.h PATH_SUFFIXES lib3mf)
find_library(LIB3MF_LIBRARY 3MF)
mark_as_advanced(LIB3MF_INCLUDE_DIR LIB3MF_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(lib3mf REQUIRED_VARS LIB3MF_LIBRARY LIB3MF_INCLUDE_DIR)
if(lib3mf_FOUND AND NOT TARGET lib3mf::lib3mf)
  add_library(lib3mf::lib3mf UNKNOWN IMPORTED)
  set_target_properties(lib3mf::lib3mf PROPERTIES IMPORTED_LOCATION "${LIB3MF_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${LIB3MF_INCLUDE_DIR}")
endif()
