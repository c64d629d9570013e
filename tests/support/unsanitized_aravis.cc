// Aravis and GLib are built without ThreadSanitizer, which therefore does not see their locks and
// would report what these guard. Linked into every test that uses them; own code stays watched.
#ifdef __SANITIZE_THREAD__
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:libaravis-0.8.so\n"
         "called_from_lib:libglib-2.0.so\n"
         "called_from_lib:libgobject-2.0.so\n"
         "called_from_lib:libgio-2.0.so\n";
}
#endif
