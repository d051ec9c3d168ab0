#include "HallActor.h"

#include "HallGame.h"

void AHallActor::BeginPlay()
{
    Super::BeginPlay();
    if (FPlatformMisc::GetEnvironmentVariable(TEXT("TLTL_PORT")).IsEmpty())
    {
        return;
    }
    const int Status = hall_play();
    FPlatformMisc::RequestExitWithStatus(false, static_cast<uint8>(Status));
}
