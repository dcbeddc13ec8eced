/* Windows calls this when it loads the library; there is nothing to set up. It stands in for the C runtime's own. */
int __stdcall DllMainCRTStartup(void *library, unsigned long reason, void *reserved)
{
    (void)library; (void)reason; (void)reserved;
    return 1;
}
