// Branching: three switches in order, then the exit behind an open barrier, alive throughout; 600 steps.

namespace ByHand
{
    using System;

    public struct Signals
    {
        public double DistanceS1;
        public double DistanceS2;
        public double DistanceS3;
        public double DistanceERight;
        public double DistanceELeft;
        public bool OpenRight;
        public bool OpenLeft;
        public double Health;
    }

    /// <summary>States 0, 1 and 3 wait for a switch, 4 for an exit, 5 is the goal, 2 is the trap.</summary>
    public sealed class Monitor : Episode
    {
        private const int Trap = 2;
        private const int Exits = 4;
        private const int Goal = 5;
        private const int Limit = 600;
        private static readonly string[] Atoms = {"near(s1)", "near(s2)", "near(s3)"};

        private static readonly string[] Labels =
        {
            "F(near(s1) & X F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))))) & G alive",
            "F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left)))) & G alive",
            "false",
            "F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))) & G alive",
            "F(open_right & near(e_right) | open_left & near(e_left)) & G alive",
            "G alive",
        };

        public static readonly string[] English =
        {
            "Reach near(s1), then near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
            "Reach near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
            "The spec is violated.",
            "Reach near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
            "Reach (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
            "Keep alive throughout.",
        };

        private static readonly Verdict[] Verdicts =
        {
            Verdict.Pending, Verdict.Pending, Verdict.Violated, Verdict.Pending, Verdict.Pending, Verdict.Holding
        };

        private static readonly int[] Switch = {0, 1, -1, 2, -1, -1};
        private static readonly int[] Next = {1, 3, -1, 4, -1, -1};

        public Monitor(double levelSize = 20.0) : base(levelSize)
        {
        }

        /// <summary>Take one sample; throws, and the state stays, where a signal is not finite.</summary>
        public Result Step(Signals signals)
        {
            Check("distance(s1)", signals.DistanceS1);
            Check("distance(s2)", signals.DistanceS2);
            Check("distance(s3)", signals.DistanceS3);
            Check("distance(e_right)", signals.DistanceERight);
            Check("distance(e_left)", signals.DistanceELeft);
            Check("health", signals.Health);
            double alive = Math.Min(Math.Max(signals.Health, 0.0), 1.0);
            var result = new Result();
            double progress = 0.0;
            if (State == Trap)
            {
                result.Robustness = 1.0;
            }
            else if (alive <= 0.0)
            {
                State = Trap;
            }
            else if (State == Goal)
            {
                result.Robustness = alive;
                progress = 1.0;
            }
            else if (State == Exits)
            {
                double rightOpen = signals.OpenRight ? 1.0 : -1.0, rightNear = Near(signals.DistanceERight);
                double leftOpen = signals.OpenLeft ? 1.0 : -1.0, leftNear = Near(signals.DistanceELeft);
                double right = Math.Min(rightOpen, rightNear);
                double left = Math.Min(leftOpen, leftNear);
                double nearest = Math.Max(right, left);
                if (nearest > 0.0)
                {
                    State = Goal;
                    result.Robustness = Math.Min(nearest, alive);
                    progress = 1.0;
                }
                else
                {
                    result.Robustness = Math.Min(-nearest, alive);
                    progress = (4.0 + nearest) / 4.0;
                    if (right >= left) result.Limiting = rightOpen <= rightNear ? "open_right" : "near(e_right)";
                    else result.Limiting = leftOpen <= leftNear ? "open_left" : "near(e_left)";
                }
            }
            else
            {
                int number = Switch[State];
                double distance = number == 0 ? signals.DistanceS1
                    : number == 1 ? signals.DistanceS2 : signals.DistanceS3;
                double closeness = Near(distance);
                if (closeness > 0.0)
                {
                    State = Next[State];
                    result.Robustness = Math.Min(closeness, alive);
                    progress = (number + 1) / 4.0;
                }
                else
                {
                    result.Robustness = Math.Min(-closeness, alive);
                    result.Limiting = Atoms[number];
                    progress = (number + 1.0 + closeness) / 4.0;
                }
            }
            result.Accepting = State == Goal;
            result.Reward = Advance(progress, State == Trap, State == Trap || State == Goal, Limit);
            result.State = State;
            result.Label = Labels[State];
            result.FailedStep = FailedStep;
            result.Verdict = Verdicts[State];
            result.Done = Done;
            result.Progress = Progress;
            return result;
        }
    }
}
