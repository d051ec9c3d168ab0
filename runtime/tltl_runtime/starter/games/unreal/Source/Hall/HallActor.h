// The game in Unreal: put this actor into the first level. If tltlc has started the game, it plays; the game then ends.

#pragma once

#include "CoreMinimal.h"
#include "GameFramework/Actor.h"
#include "HallActor.generated.h"

UCLASS()
class AHallActor : public AActor
{
    GENERATED_BODY()

protected:
    virtual void BeginPlay() override;
};
