import jade.core.Agent;
import jade.core.ContainerID;
import jade.core.Profile;
import jade.core.ProfileImpl;
import jade.core.Runtime;
import jade.core.behaviours.CyclicBehaviour;
import jade.wrapper.AgentContainer;
import java.util.LinkedHashMap;
import java.util.Map;
import java.util.concurrent.CountDownLatch;
import java.util.logging.LogManager;

/**
 * JADE's hops for bench/peers.pl: two containers in two processes, and an
 * agent that moves to and fro.
 *
 *   java -cp CLASSES:JADE Hop hops
 *
 * The agent has 10 facts in a map. Its class, of 30 methods, is known on
 * both sides and does not travel.
 */
public class Hop {
    static CountDownLatch done;

    public static void main(String[] args) throws Exception {
        quiet();
        if (args.length == 1)
            here(Bench.freePort());
        else {
            container(args[1], false);
            Bench.other("ready");
        }
        System.exit(0);
    }

    /** JADE is talkative. */
    static void quiet() {
        System.setOut(System.err);
        LogManager.getLogManager().reset();
    }

    static AgentContainer container(String port, boolean main)
            throws Exception {
        Profile profile = new ProfileImpl(main);
        profile.setParameter(Profile.MAIN_HOST, "127.0.0.1");
        profile.setParameter(Profile.MAIN_PORT, port);
        profile.setParameter(Profile.LOCAL_HOST, "127.0.0.1");
        profile.setParameter("nomtp", "true");
        profile.setParameter(Profile.FILE_DIR,      // not where we are
            System.getProperty("java.class.path").split(":")[0] + "/");
        profile.setParameter(Profile.SERVICES,
            "jade.core.mobility.AgentMobilityService");
        if (main)
            return Runtime.instance().createMainContainer(profile);
        profile.setParameter(Profile.LOCAL_PORT, Bench.freePort());
        profile.setParameter(Profile.CONTAINER_NAME, "there");
        return Runtime.instance().createAgentContainer(profile);
    }

    static void here(String port) throws Exception {
        AgentContainer container = container(port, true);
        Bench.withOther(line -> {
            travel(container, 1, 4000);         // warm up
            Bench.measured("hops(one)", 4000,
                           () -> travel(container, 1, 4000));
            Bench.measured("hops(ten)", 6000,
                           () -> travel(container, 10, 6000));
        }, "Hop", "there", port);
    }

    static void travel(AgentContainer container, int agents, int hops)
            throws Exception {
        done = new CountDownLatch(agents);
        for (int i = 0; i < agents; i++)
            container.createNewAgent("traveller" + System.nanoTime(),
                "Hop$Traveller", new Object[] { hops / agents }).start();
        done.await();
    }

    public static class Traveller extends Agent {
        final Map<String, Object> facts = new LinkedHashMap<>();

        protected void setup() {
            facts.put("left", getArguments()[0]);
            facts.put("there", true);
            for (int i = 1; i <= 8; i++)
                facts.put("fact" + i, i);
            addBehaviour(new Travel());
        }

        void step() {
            int left = (Integer) facts.get("left");
            if (left == 0) {
                done.countDown();
                doDelete();
                return;
            }
            boolean there = (Boolean) facts.get("there");
            facts.put("left", left - 1);
            facts.put("there", !there);
            doMove(new ContainerID(there ? "there" : "Main-Container", null));
        }

        boolean rule1(int x) { int y = x + 1; return y > 0 && other(y); }
        boolean rule2(int x) { int y = x + 2; return y > 0 && other(y); }
        boolean rule3(int x) { int y = x + 3; return y > 0 && other(y); }
        boolean rule4(int x) { int y = x + 4; return y > 0 && other(y); }
        boolean rule5(int x) { int y = x + 5; return y > 0 && other(y); }
        boolean rule6(int x) { int y = x + 6; return y > 0 && other(y); }
        boolean rule7(int x) { int y = x + 7; return y > 0 && other(y); }
        boolean rule8(int x) { int y = x + 8; return y > 0 && other(y); }
        boolean rule9(int x) { int y = x + 9; return y > 0 && other(y); }
        boolean rule10(int x) { int y = x + 10; return y > 0 && other(y); }
        boolean rule11(int x) { int y = x + 11; return y > 0 && other(y); }
        boolean rule12(int x) { int y = x + 12; return y > 0 && other(y); }
        boolean rule13(int x) { int y = x + 13; return y > 0 && other(y); }
        boolean rule14(int x) { int y = x + 14; return y > 0 && other(y); }
        boolean rule15(int x) { int y = x + 15; return y > 0 && other(y); }
        boolean rule16(int x) { int y = x + 16; return y > 0 && other(y); }
        boolean rule17(int x) { int y = x + 17; return y > 0 && other(y); }
        boolean rule18(int x) { int y = x + 18; return y > 0 && other(y); }
        boolean rule19(int x) { int y = x + 19; return y > 0 && other(y); }
        boolean rule20(int x) { int y = x + 20; return y > 0 && other(y); }
        boolean rule21(int x) { int y = x + 21; return y > 0 && other(y); }
        boolean rule22(int x) { int y = x + 22; return y > 0 && other(y); }
        boolean rule23(int x) { int y = x + 23; return y > 0 && other(y); }
        boolean rule24(int x) { int y = x + 24; return y > 0 && other(y); }
        boolean rule25(int x) { int y = x + 25; return y > 0 && other(y); }
        boolean rule26(int x) { int y = x + 26; return y > 0 && other(y); }
        boolean rule27(int x) { int y = x + 27; return y > 0 && other(y); }
        boolean other(int y) { return true; }
    }

    static class Travel extends CyclicBehaviour {
        public void action() {
            ((Traveller) myAgent).step();
        }
    }
}
