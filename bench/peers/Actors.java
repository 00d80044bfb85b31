import com.typesafe.config.ConfigFactory;
import java.time.Duration;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import java.util.concurrent.CountDownLatch;
import org.apache.pekko.actor.AbstractActor;
import org.apache.pekko.actor.ActorRef;
import org.apache.pekko.actor.ActorSystem;
import org.apache.pekko.actor.ExtendedActorSystem;
import org.apache.pekko.actor.Props;

/**
 * Apache Pekko's actors for bench/peers.pl.
 *
 *   java -cp CLASSES:JARS Actors start | idle | messages
 *
 * Classic actors. A message is a string. The other process has the actors
 * remote0 to remote9, which are reached by Artery over TCP.
 */
public class Actors {
    static ActorSystem system;

    public static void main(String[] args) throws Exception {
        boolean remote = args[0].equals("messages") || args[0].equals("there");
        system = ActorSystem.create("bench", ConfigFactory.parseString(
            "pekko { loglevel = OFF, stdout-loglevel = OFF"
            + (remote ? ", actor.provider = remote, remote.artery {"
               + " transport = tcp, canonical {"
               + " hostname = 127.0.0.1, port = 0 } } }" : " }"))
            .withFallback(ConfigFactory.load()));
        switch (args[0]) {
            case "start":
                answers(1);
                Bench.tell("done(start, 1)");
                Bench.tell("version('Pekko "
                    + system.settings().ConfigVersion() + ", Java "
                    + Runtime.version().feature() + "')");
                break;
            case "idle":
                System.gc();
                Bench.measured("memory", 10000, () -> {
                    for (int i = 0; i < 10000; i++)
                        system.actorOf(Props.create(Pong.class));
                    System.gc();
                });
                break;
            case "messages":
                answers(500);                   // warm up
                Bench.measured("answers", 100000, () -> answers(100000));
                pairs("local", pongs("local"), 20);
                Bench.withOther(port -> pairs("remote", remote(port), 1),
                                "Actors", "there");
                break;
            case "there":
                pongs("remote");
                Bench.other("" + ((ExtendedActorSystem) system).provider()
                            .getDefaultAddress().port().get());
        }
        System.exit(0);
    }

    static void answers(int count) throws Exception {
        CountDownLatch done = new CountDownLatch(1);
        system.actorOf(Props.create(Asker.class, count, done));
        done.await();
    }

    static List<ActorRef> pongs(String where) {
        List<ActorRef> pongs = new ArrayList<>();
        for (int i = 0; i < 10; i++)
            pongs.add(system.actorOf(Props.create(Pong.class), where + i));
        return pongs;
    }

    static List<ActorRef> remote(String port) throws Exception {
        List<ActorRef> pongs = new ArrayList<>();
        for (int i = 0; i < 10; i++)
            pongs.add(system.actorSelection("pekko://bench@127.0.0.1:" + port
                                            + "/user/remote" + i)
                .resolveOne(Duration.ofSeconds(30))
                .toCompletableFuture().get());
        return pongs;
    }

    static void pairs(String where, List<ActorRef> pongs, int times)
            throws Exception {
        paired(pongs, 1, 1000);                 // warm up
        Bench.measured(where + "(one)", times * 20000,
                       () -> paired(pongs, 1, times * 20000));
        Bench.measured(where + "(ten)", times * 40000,
                       () -> paired(pongs, 10, times * 40000));
    }

    static void paired(List<ActorRef> pongs, int pairs, int messages)
            throws Exception {
        CountDownLatch done = new CountDownLatch(pairs);
        for (int i = 0; i < pairs; i++)
            system.actorOf(Props.create(Ping.class, pongs.get(i),
                                        messages / pairs / 2, done));
        done.await();
    }

    /** Goes on when an answer comes, until all have come. */
    abstract static class Counter extends AbstractActor {
        int left;
        CountDownLatch done;

        abstract void ask();

        public void preStart() {
            ask();
        }

        public Receive createReceive() {
            return receiveBuilder().match(String.class, text -> {
                if (--left > 0)
                    ask();
                else {
                    done.countDown();
                    getContext().stop(self());
                }
            }).build();
        }
    }

    static class Asker extends Counter {
        Asker(Integer count, CountDownLatch done) {
            left = count;
            this.done = done;
        }

        void ask() {
            getContext().actorOf(Props.create(Answerer.class))
                .tell(Bench.TEXT, self());
        }
    }

    static class Ping extends Counter {
        final ActorRef pong;

        Ping(ActorRef pong, Integer count, CountDownLatch done) {
            this.pong = pong;
            left = count;
            this.done = done;
        }

        void ask() {
            pong.tell(Bench.TEXT, self());
        }
    }

    static class Answerer extends AbstractActor {
        public Receive createReceive() {
            return receiveBuilder().match(String.class, text -> {
                sender().tell(text, self());
                getContext().stop(self());
            }).build();
        }
    }

    static class Pong extends AbstractActor {
        final Map<String, Integer> facts = new HashMap<>();

        public Receive createReceive() {
            for (int i = 1; i <= 10; i++)
                facts.put("fact" + i, i);
            return receiveBuilder().match(String.class, text ->
                sender().tell(text, self())).build();
        }
    }
}
