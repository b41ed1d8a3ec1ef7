// Fast DDS 2.9 deletes some of its own objects through a base of another size. That is no fault of the code
// under test, and everything else the address sanitizer finds still counts.
extern "C" const char*
__asan_default_options();  // NOLINT(bugprone-reserved-identifier): the sanitizer's name

extern "C" const char* __asan_default_options() {  // NOLINT(bugprone-reserved-identifier)
  return "new_delete_type_mismatch=0";
}
