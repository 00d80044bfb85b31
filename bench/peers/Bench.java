import java.io.BufferedReader;
import java.io.FileDescriptor;
import java.io.FileOutputStream;
import java.io.InputStreamReader;
import java.io.PrintStream;
import java.net.ServerSocket;
import java.util.ArrayList;
import java.util.Collections;
import java.util.List;

/** The protocol of bench/peers.pl, for the platforms in Java. */
class Bench {
    static final String TEXT =
        String.join("", Collections.nCopies(10, "0123456789"));

    /* System.out may be another one by now. */
    static final PrintStream out =
        new PrintStream(new FileOutputStream(FileDescriptor.out), true);
    static final BufferedReader in =
        new BufferedReader(new InputStreamReader(System.in));

    interface Work {
        void run() throws Exception;
    }

    interface Use {
        void of(String line) throws Exception;
    }

    static void measured(String measure, int count, Work work)
            throws Exception {
        tell("begin");
        work.run();
        tell("done(" + measure + ", " + count + ")");
    }

    static void tell(String fact) throws Exception {
        out.println(fact + ".");
        in.readLine();
    }

    /** Runs class Main in another process while the first line that it
        prints is used. It ends with its standard input. */
    static void withOther(Use use, String main, String... args)
            throws Exception {
        List<String> command = new ArrayList<>(List.of(
            System.getProperty("java.home") + "/bin/java", "-cp",
            System.getProperty("java.class.path"), main));
        command.addAll(List.of(args));
        Process process = new ProcessBuilder(command)
            .redirectError(ProcessBuilder.Redirect.INHERIT).start();
        try {
            use.of(new BufferedReader(new InputStreamReader(
                process.getInputStream())).readLine());
        } finally {
            process.getOutputStream().close();
            process.waitFor();
        }
    }

    static void other(String line) throws Exception {
        out.println(line);
        while (in.readLine() != null)
            ;
    }

    static String freePort() throws Exception {
        try (ServerSocket socket = new ServerSocket(0)) {
            return "" + socket.getLocalPort();
        }
    }
}
