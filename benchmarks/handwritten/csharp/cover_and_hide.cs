// Cover and Hide: near(s1), then near(s2), then near(exit), alive throughout; judged at the goal, 400 steps.  The three
// places exclude each other.

namespace ByHand
{
    using System;

    public struct Signals
    {
        public double DistanceS1;
        public double DistanceS2;
        public double DistanceExit;
        public double Health;
    }

    /// <summary>States 0, 1 and 3 wait for a place, 4 is the goal, 2 is the trap.</summary>
    public sealed class Monitor : Episode
    {
        private const int Trap = 2;
        private const int Goal = 4;
        private const int Limit = 400;
        private static readonly string[] Atoms = {"near(s1)", "near(s2)", "near(exit)"};

        private static readonly string[] Labels =
        {
            "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive",
            "F(near(s2) & X F near(exit)) & G alive",
            "false",
            "F near(exit) & G alive",
            "G alive",
        };

        public static readonly string[] English =
        {
            "Reach near(s1), then near(s2), then near(exit), and keep alive throughout.",
            "Reach near(s2), then near(exit), and keep alive throughout.",
            "The spec is violated.",
            "Reach near(exit), and keep alive throughout.",
            "Keep alive throughout.",
        };

        private static readonly Verdict[] Verdicts =
        {
            Verdict.Pending, Verdict.Pending, Verdict.Violated, Verdict.Pending, Verdict.Holding
        };

        private static readonly int[] Place = {0, 1, -1, 2, -1};
        private static readonly int[] Next = {1, 3, -1, 4, -1};

        public Monitor(double levelSize = 20.0) : base(levelSize)
        {
        }

        /// <summary>
        /// Take one sample; throws, and the state stays, where a signal is not finite or two places are near at once.
        /// </summary>
        public Result Step(Signals signals)
        {
            Check("distance(s1)", signals.DistanceS1);
            Check("distance(s2)", signals.DistanceS2);
            Check("distance(exit)", signals.DistanceExit);
            Check("health", signals.Health);
            double s1 = Near(signals.DistanceS1);
            double s2 = Near(signals.DistanceS2);
            double exit = Near(signals.DistanceExit);
            double alive = Math.Min(Math.Max(signals.Health, 0.0), 1.0);
            if ((s1 > 0.0 && (s2 > 0.0 || exit > 0.0)) || (s2 > 0.0 && exit > 0.0))
            {
                throw new ArgumentException("only one of " + string.Join(", ", Atoms) + " may hold at a time");
            }
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
            else
            {
                int place = Place[State];
                double here = place == 0 ? s1 : place == 1 ? s2 : exit;
                if (here > 0.0)
                {
                    State = Next[State];
                    result.Robustness = Math.Min(here, alive);
                    progress = (place + 1) / 3.0;
                }
                else
                {
                    // At another place the player is certainly not here, because the places exclude each other.
                    double elsewhere = Math.Max(place == 0 ? s2 : s1, place == 2 ? s2 : exit);
                    result.Robustness = Math.Min(Math.Max(-here, elsewhere), alive);
                    result.Limiting = Atoms[place];
                    progress = (place + 1.0 + here) / 3.0;
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
