import jade.core.AID;
import jade.core.Agent;
import jade.core.behaviours.CyclicBehaviour;
import jade.lang.acl.ACLMessage;
import jade.lang.acl.MessageTemplate;
import jade.wrapper.AgentContainer;
import java.util.HashMap;
import java.util.Map;
import java.util.concurrent.CountDownLatch;
import java.util.concurrent.atomic.AtomicInteger;

/**
 * JADE's agents for bench/peers.pl.
 *
 *   java -cp CLASSES:JADE Agents start | idle | messages
 *
 * A message is an ACL message with a text. Each agent has a thread: a fifth
 * as many are idle as on other platforms, which takes some seconds. The other process is a container
 * of the same platform, with the agents remote0 to remote9.
 */
public class Agents {
    static final AtomicInteger names = new AtomicInteger();

    public static void main(String[] args) throws Exception {
        Hop.quiet();
        boolean main = args.length == 1;
        String port = main ? Bench.freePort() : args[1];
        AgentContainer container = Hop.container(port, main);
        switch (args[0]) {
            case "start":
                answers(container, 1);
                Bench.tell("done(start, 1)");
                Bench.tell("version('JADE "
                    + jade.core.Runtime.getVersion() + ", Java "
                    + java.lang.Runtime.version().feature() + "')");
                break;
            case "idle":
                System.gc();
                Bench.measured("memory", 2000, () -> {
                    for (int i = 0; i < 2000; i++)
                        create(container, Pong.class, "");
                    System.gc();
                });
                break;
            case "messages":
                answers(container, 500);        // warm up
                Bench.measured("answers", 3000,
                               () -> answers(container, 3000));
                pongs(container, "local");
                pairs(container, "local", 10);
                Bench.withOther(line -> pairs(container, "remote", 1),
                                "Agents", "there", port);
                break;
            case "there":
                pongs(container, "remote");
                Bench.other("ready");
        }
        System.exit(0);
    }

    static void create(AgentContainer container, Class<?> kind,
                       Object... args) throws Exception {
        container.createNewAgent("agent" + names.incrementAndGet(),
                                 kind.getName(), args).start();
    }

    static void answers(AgentContainer container, int count)
            throws Exception {
        CountDownLatch done = new CountDownLatch(1);
        create(container, Asker.class, count, done);
        done.await();
    }

    static void pongs(AgentContainer container, String where)
            throws Exception {
        for (int i = 0; i < 10; i++)
            container.createNewAgent(where + i, "Agents$Pong", null).start();
    }

    static void pairs(AgentContainer container, String where, int times)
            throws Exception {
        paired(container, where, 1, 1000);      // warm up
        Bench.measured(where + "(one)", times * 5000,
                       () -> paired(container, where, 1, times * 5000));
        Bench.measured(where + "(ten)", times * 10000,
                       () -> paired(container, where, 10, times * 10000));
    }

    static void paired(AgentContainer container, String where, int pairs,
                       int messages) throws Exception {
        CountDownLatch done = new CountDownLatch(pairs);
        for (int i = 0; i < pairs; i++)
            create(container, Ping.class, where + i, messages / pairs / 2,
                   done);
        done.await();
    }

    static ACLMessage asked(Agent agent, String name) {
        AID aid = new AID(name, AID.ISLOCALNAME);
        ACLMessage message = new ACLMessage(ACLMessage.REQUEST);
        message.addReceiver(aid);
        message.setContent(Bench.TEXT);
        agent.send(message);
        return agent.blockingReceive(MessageTemplate.MatchSender(aid));
    }

    static void answer(Agent agent, ACLMessage message) {
        ACLMessage reply = message.createReply();
        reply.setContent(message.getContent());
        agent.send(reply);
    }

    public static class Asker extends Agent {
        protected void setup() {
            try {
                for (int i = (Integer) getArguments()[0]; i > 0; i--) {
                    String name = "agent" + names.incrementAndGet();
                    getContainerController().createNewAgent(
                        name, "Agents$Answerer", null).start();
                    asked(this, name);
                }
            } catch (Exception e) {
                e.printStackTrace();
            }
            ((CountDownLatch) getArguments()[1]).countDown();
            doDelete();
        }
    }

    public static class Answerer extends Agent {
        protected void setup() {
            answer(this, blockingReceive());
            doDelete();
        }
    }

    public static class Ping extends Agent {
        protected void setup() {
            Object[] args = getArguments();
            for (int i = (Integer) args[1]; i > 0; i--)
                asked(this, (String) args[0]);
            ((CountDownLatch) args[2]).countDown();
            doDelete();
        }
    }

    public static class Pong extends Agent {
        final Map<String, Integer> facts = new HashMap<>();

        protected void setup() {
            for (int i = 1; i <= 10; i++)
                facts.put("fact" + i, i);
            addBehaviour(new CyclicBehaviour() {
                public void action() {
                    ACLMessage message = receive();
                    if (message == null)
                        block();
                    else
                        answer(myAgent, message);
                }
            });
        }
    }
}
