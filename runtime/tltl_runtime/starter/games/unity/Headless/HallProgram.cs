// The game without Unity: `mcs -out:hall.exe Assets/Tltl/TltlClient.cs Assets/Hall/Hall.cs Headless/HallProgram.cs`

using Tltl;

internal static class HallProgram
{
    private static int Main()
    {
        return TltlClient.Play(new Hall());
    }
}
