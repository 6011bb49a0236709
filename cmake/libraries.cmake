# Every external library is found here, once. packages.txt names the Debian packages that bring them.
find_package(SQLite3 REQUIRED)
find_package(Threads REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(Boost REQUIRED)
find_package(Qhull REQUIRED)
find_package(assimp REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(JPEG REQUIRED)
find_package(PNG REQUIRED)
find_package(OpenSSL REQUIRED)
pkg_check_modules(stb REQUIRED IMPORTED_TARGET stb)
pkg_check_modules(minizip REQUIRED IMPORTED_TARGET minizip)
pkg_check_modules(pugixml REQUIRED IMPORTED_TARGET pugixml)
pkg_check_modules(qrencode REQUIRED IMPORTED_TARGET libqrencode)
pkg_check_modules(seccomp REQUIRED IMPORTED_TARGET libseccomp)
find_package(embree 3 REQUIRED)
# VRML only; without it a .wrl is refused with the name of the package.
find_package(Coin CONFIG QUIET)
if(NOT TARGET Coin::Coin)
  message(STATUS "VRML will not be read: libcoin-dev is not installed.")
endif()

# Text files, not a library: the nouns are compiled into a table while building.
find_path(EMBODY_WORDNET data.noun PATHS /usr/share/wordnet /usr/share/wordnet/dict /usr/share/wordnet-3.0/dict
          DOC "Folder of WordNet 3.0's data.noun, index.noun and noun.exc" NO_DEFAULT_PATH)
if(NOT EMBODY_WORDNET)
  message(FATAL_ERROR "WordNet's data.noun is not there: install wordnet-base, or give -DEMBODY_WORDNET=FOLDER.")
endif()

# Groups by the layer that uses them.
add_library(embody_model_readers INTERFACE)
target_link_libraries(embody_model_readers INTERFACE assimp::assimp PkgConfig::minizip PkgConfig::pugixml JPEG::JPEG PNG::PNG PkgConfig::stb
                      nlohmann_json::nlohmann_json meshoptimizer::meshoptimizer)
if(TARGET Coin::Coin)
  target_link_libraries(embody_model_readers INTERFACE Coin::Coin)
  target_compile_definitions(embody_model_readers INTERFACE EMBODY_HAS_COIN)
endif()

add_library(embody_preparation_libraries INTERFACE)
target_link_libraries(embody_preparation_libraries INTERFACE PkgConfig::seccomp embree Threads::Threads)

add_library(embody_catalog_libraries INTERFACE)
target_link_libraries(embody_catalog_libraries INTERFACE nlohmann_json::nlohmann_json Threads::Threads)

add_library(embody_server_libraries INTERFACE)
target_link_libraries(embody_server_libraries INTERFACE Boost::headers OpenSSL::SSL OpenSSL::Crypto
                      nlohmann_json::nlohmann_json Threads::Threads)
